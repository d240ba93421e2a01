"""A velocity with noise that hides its change, or that blurs friction at low speed."""

from __future__ import annotations

from collections.abc import Iterator

from jointid.base.advice import Action
from jointid.estimate.findings import TITLE, Finding, Measured
from jointid.estimate.wording import percent, two_digits
from jointid.identification.warnings.check import Check, FindingType
from jointid.identification.warnings.evidence import Evidence
from jointid.identification.warnings.inspection import Inspected
from jointid.identification.warnings.undetermined import HIDES, listed, with_partners
from jointid.recording.order_statistics import median
from jointid.recording.velocity_noise import noise_of_velocity

NOISY_VELOCITY = FindingType(
    code="noisy_velocity",
    meaning="velocity noise changes a parameter by more than 2 % and by more than half of its standard error. Or the "
    "noise is large compared with the change of velocity in windows of every length. The identified inertia is then "
    "too small",
    advice="record the position with a finer resolution, or record longer. Leave the velocity column out if it is "
    "noisier than the position's derivative",
)
_MOVED = 0.02  # of the value: twice this is wide in the sense of `undetermined`
_OF_TORQUE = 0.05  # of the torque's level: smallest reference for a constant torque
_MANY = 10.0  # of the value: a larger share is not shown as a share
_OF_ERROR = 0.5  # of the standard error: a smaller change adds at most an eighth to it
_QUIETER = 0.5  # of the recorded velocity's noise
_JITTER = 0.02  # sample periods between position and stamps
_FINER = Action("record", text="the position with a finer resolution, or for longer")
_DERIVED = Action(
    "call",
    {"columns": {"velocity": None}},
    text="the position's derivative is less noisy than this column",
    function="load",
)


def _find(evidence: Evidence) -> Iterator[Finding]:
    moved = {
        name: share
        for name, share in moved_by_noise(evidence).items()
        if _size_of(evidence, name) >= _OF_ERROR * (evidence.parameters[name].stderr or 0.0)
    }
    # Running integrals have no window edges, so noise does not matter.
    limited = evidence.penalty.noise_limited and not evidence.penalty.cumulative
    if not (limited or moved):
        return
    causes, details, measured = [], [], {}
    named = list(moved)
    if limited:
        share = evidence.residuals.noise_share
        about = f"about {percent(share)}" if share < HIDES else "far"
        causes.append(f"velocity noise is {percent(share)} of the velocity's change over a window")
        details.append(f"inertia is {about} too small")
        details.append("for windows of any length, noise is more than 1 % of the velocity's change")
        measured["noise_share"] = Measured(share)
        inertia = evidence.parameters.get("inertia")
        if inertia is not None and inertia.vary and "inertia" not in named:
            named.insert(0, "inertia")
    if moved:
        sizes = [f"{name} by {_size(evidence, name, each)}" for name, each in moved.items()]
        text = "velocity noise moves "
        causes.append(f"{text}{listed(sizes, TITLE - len(text))}")
        details += filter(
            None,
            (_resolution(evidence), "these changes are computed with a simulated second recording"),
        )
        measured |= {f"{name}.moved": Measured(share) for name, share in moved.items()}
    # With the stamps of a busy computer the position's rate is wrong, even if it looks quiet.
    stamped = all(_are_stamps_right(inspected) for inspected in evidence.inspections)
    quieter = stamped and any(
        _derived_is_quieter(evidence, number) for number in range(len(evidence.recordings))
    )
    yield NOISY_VELOCITY.finding(
        causes[0],
        *((_DERIVED,) if quieter else ()),
        _FINER,
        details="; ".join((*causes[1:], *details)),
        evidence=measured,
        parameters=with_partners(evidence, named),
    )


def _are_stamps_right(inspected: Inspected) -> bool:
    return inspected.found.timing_errors[0] < _JITTER * inspected.recording.sample_period


def moved_by_noise(evidence: Evidence) -> dict[str, float]:
    """Return the relative change of each parameter by the velocity's noise; only large changes.

    A value at its bound is omitted: `at_bound` reports it, and its size is no reference for a change.
    """
    effect = evidence.velocity_effect
    if effect is None:
        return {}
    parameters = [evidence.parameters[name] for name in evidence.penalty.names]
    shares = {}
    for parameter, size in zip(parameters, effect.size.tolist(), strict=True):
        level = abs(parameter.value)
        if parameter.name.endswith("_offset") or parameter.name.startswith("gravity"):
            level = max(level, _OF_TORQUE * evidence.torque_level)
        inside = parameter.vary and parameter.at_bound is None
        if inside and size > _MOVED * level > 0.0:
            shares[parameter.name] = size / level
    return shares


def _size(evidence: Evidence, name: str, share: float) -> str:
    """Return the change of a value by noise: as a share, or as an amount if the value is near zero."""
    p = evidence.parameters[name]
    if abs(p.value) >= p.uncertainty and share <= _MANY:
        return percent(share)
    return f"{two_digits(_size_of(evidence, name))} {p.unit}".rstrip()


def _size_of(evidence: Evidence, name: str) -> float:
    """Return the change of a value by noise, in its unit; 0 if no effect of noise is known."""
    effect = evidence.velocity_effect
    if effect is None:
        return 0.0
    return float(effect.size[list(evidence.penalty.names).index(name)])


def _resolution(evidence: Evidence) -> str:
    run = evidence.recordings[0]
    step = run.derived.position_noise.quantum
    if not (run.velocity_derived and step > 0.0):
        return ""
    return f"the position has steps of {step:.3g} {run.unit('position')}"


def _derived_is_quieter(evidence: Evidence, number: int) -> bool:
    run = evidence.recordings[number]
    if run.velocity_derived:
        return False
    return median(run.derived.noise) < _QUIETER * noise_of_velocity(run)


CHECK = Check(_find, (NOISY_VELOCITY,))
