"""Extra signals of own terms with noise that changes parameters."""

from __future__ import annotations

from collections.abc import Iterator

from jointid.base.advice import Action
from jointid.estimate.findings import TITLE, Finding, Measured
from jointid.estimate.wording import percent
from jointid.identification.warnings.check import Check, FindingType
from jointid.identification.warnings.evidence import Evidence
from jointid.identification.warnings.undetermined import listed, scale_of

NOISY_SIGNAL = FindingType(
    code="noisy_signal",
    meaning="noise in the extra signals of own terms changes a parameter by more than 1.5 %. Noise in a signal makes "
    "the coefficient of this signal too small",
    advice="record the signal with less noise, or filter it without delay. Fix the coefficient if you know its value",
)
_MOVED = 0.015  # of the value
_NAMES = 40  # characters


def _find(evidence: Evidence) -> Iterator[Finding]:
    noise = evidence.own_noise
    if noise is None:
        return
    moved = {}
    parameters = [evidence.parameters[name] for name in evidence.penalty.names]
    for parameter, size in zip(parameters, noise.effect.size.tolist(), strict=True):
        scale = scale_of(parameter, evidence)
        if parameter.vary and size > _MOVED * scale > 0.0:
            moved[parameter.name] = size / scale
    if not moved:
        return
    units = evidence.recordings[0]
    own = evidence.problem.choice.model.resolved.terms
    terms = {name.partition("[")[0] for name in moved}
    blamed = [each.signal for each in own.each if terms & set(each.keys)]
    noisy = {name: sigma for name, sigma in noise.noise if name in blamed or not blamed}
    deviations = [
        f"{name} {sigma:.2g} {units.unit(name)}".rstrip() for name, sigma in noisy.items()
    ]
    text = f"noise in {listed(noisy, _NAMES)} moves "
    sizes = [f"{name} by {percent(share)}" for name, share in moved.items()]
    yield NOISY_SIGNAL.finding(
        f"{text}{listed(sizes, TITLE - len(text))}",
        Action("record", text=f"{listed(noisy, _NAMES)} with less noise"),
        details="noise in a signal makes the coefficient of this signal too small; the changes are computed with a "
        f"simulated second recording; standard deviation of the noise: {listed(deviations)}",
        evidence={f"{name}.moved": Measured(share) for name, share in moved.items()}
        | {f"{name}.noise": Measured(sigma) for name, sigma in noise.noise},
        parameters=tuple(moved),
    )


CHECK = Check(_find, (NOISY_SIGNAL,))
