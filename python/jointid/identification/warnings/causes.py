"""Causes of a misfit by name: what the model lacks, how much it explains, and what it moves."""

from __future__ import annotations

from collections.abc import Iterator

from jointid.estimate.causes import MEANINGS, Cause
from jointid.estimate.findings import Finding, Measured
from jointid.identification.warnings.check import Check, FindingType
from jointid.identification.warnings.evidence import Evidence
from jointid.identification.warnings.ripple import RIPPLE
from jointid.identification.warnings.torque_balance import WRONG_SCALE
from jointid.identification.warnings.undetermined import listed, wide, with_partners

_REMEDIES = {
    "gravity": "identify gravity, too: `stribeck:gravity=free`",
    "inertia_varies": "move about one pose",
    "load_friction": "add load_friction to the model",
    "slow_motion": "use the model stribeck",
    "presliding": "record longer strokes with fewer reversals",
    "stribeck_exponent": "use the model stribeck_general, whose exponent is free",
    "drift": "record after warming up; identify first and last part apart",
    "harmonic": "add harmonics of that order to the model",
    "delay": "correct the stamps of the signal that is late",
    "other_signal": "record with everything else at rest",
    "disturbance": "leave that stretch of time out",
    "asymmetry": "add asymmetric to the model",
    "offset": "let the joint have a torque_offset",
}

TYPES = {
    name: FindingType(
        code=name,
        meaning=f"{MEANINGS[name]}: it explains what is left of the torque in stretches of time that it was not fitted "
        "to, and it moves a parameter",
        advice=remedy,
        picture="windows",
    )
    for name, remedy in _REMEDIES.items()
} | {"ripple": RIPPLE}


def _find(evidence: Evidence) -> Iterator[Finding]:
    if evidence.causes is None:
        return
    # Their own checks say more.
    causes = [
        each
        for each in evidence.causes.found
        if each.name != WRONG_SCALE.code and not _is_known_delay(each, evidence)
    ]
    uncertain = wide(evidence)
    for number, cause in enumerate(causes):
        # The misfit makes values uncertain beside those that a shift of first order shows.
        names = (*cause.relative, *(uncertain if number == 0 else ()))
        yield _finding(cause, with_partners(evidence, names))


def _is_known_delay(cause: Cause, evidence: Evidence) -> bool:
    delay = evidence.delays.get(cause.detail) if cause.name == "delay" else None
    return delay is not None and delay.certain


def _finding(cause: Cause, concerned: tuple[str, ...]) -> Finding:
    measured = {"share": Measured(cause.share), "windows": Measured(cause.scale, "s")}
    measured |= cause.numbers
    measured |= {f"{name}.shift": Measured(share) for name, share in cause.relative.items()}
    beside = [name for name in concerned if name not in cause.relative]
    text = f"{cause}; it also makes {listed(beside)} uncertain" if beside else str(cause)
    return TYPES[cause.name].finding(
        text, *cause.advice, evidence=measured, parameters=tuple(concerned)
    )


CHECK = Check(_find, tuple(TYPES[name] for name in _REMEDIES))
