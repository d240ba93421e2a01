"""Check whether torque, motion and sensor satisfy one torque balance: reversed signs, wrong scales."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np

from jointid.base.advice import Action
from jointid.estimate.findings import Finding, Measured
from jointid.identification.warnings.check import Check, FindingType
from jointid.identification.warnings.evidence import Evidence
from jointid.identification.warnings.torque_facts import corrections_of
from jointid.identification.warnings.unbounded import EXPLAINED, Unbounded, without_bounds
from jointid.identification.warnings.units import IMPLAUSIBLE_UNITS, degrees_advice
from jointid.identification.warnings.velocity import REVERSED_SIGN
from jointid.problem.recordings import output_torque
from jointid.problem.unsigned_torque import is_magnitude, is_one_sided
from jointid.recording.sides import READ_FROM

WRONG_SCALE = FindingType(
    code="wrong_scale",
    severity="blocking",
    meaning="the inertia in the log differs from the known inertia by more than 5 %. If this difference explains the "
    "residual, a difference of 1 % already gives a warning, but only a factor of 1.5 is blocking",
    advice="correct gear ratio, torque constant, torque unit or inertia. Identify the inertia only if its known value "
    "is wrong",
)

UNSIGNED_TORQUE = FindingType(
    code="unsigned_torque",
    severity="blocking",
    meaning="the torque is never negative although the joint moves in both directions. The log has only the "
    "magnitude of the torque",
    advice="record the torque with its sign",
)

_BOTH = 0.2  # of the windows in each direction
_AGAINST = -0.1  # correlation of torque and velocity: friction makes it positive
_SCALE = 0.05
_HIDDEN = 0.5  # of the gain: noise reduces it to this share at most, and the link's inertia is added to the joint
GROSS = 1.5  # factor of an inertia that is wrong even with such noise
_DEGREE = np.pi / 180.0


def _find(evidence: Evidence) -> Iterator[Finding]:
    if _is_unsigned(evidence):
        yield UNSIGNED_TORQUE.finding(
            "the torque has no sign: it is never negative, although the joint moves in both directions",
            Action(
                "inspect",
                text="whether the driver logs a signed torque; a servo's position error has the sign",
            ),
            details="the recorded torque fits the magnitude of a torque that changes sign",
        )
        return
    correlation = _torque_with_velocity(evidence)
    if correlation is not None:
        yield REVERSED_SIGN.finding(
            "the torque acts against the motion: torque or position has the wrong sign",
            *_flip_the_torque(evidence),
            Action("inspect", text="the signs of torque and position, and flip the wrong one"),
            details="friction takes power from the drive; here the joint seems to drive the motor",
            evidence={"correlation_with_velocity": Measured(correlation)},
        )
        return
    free = without_bounds(evidence)
    if free is None:
        return
    yield from _inertia_contradicts(evidence, free)
    yield from _sensor_reversed(evidence, free)


def _is_unsigned(evidence: Evidence) -> bool:
    """Return whether the windows' torque is the magnitude of the torque of friction, inertia and gravity."""
    torques = [output_torque(run, evidence.joint) for run in evidence.recordings]
    lowest, highest = min(each.min() for each in torques), max(each.max() for each in torques)
    if not is_one_sided(float(lowest), float(highest)) or evidence.problem.choice.sensor:
        return False
    table = evidence.table
    direction = np.sign(table.velocity)
    if min(np.mean(direction > 0.0), np.mean(direction < 0.0)) < _BOTH:
        return False
    middle = 0.5 * (table.start + table.stop)
    angle = np.empty(len(middle))
    for number, run in enumerate(evidence.recordings):
        here = table.recording == number
        angle[here] = np.interp(middle[here], run.time, run.position)
    weight = [wave(angle) * table.duration for wave in (np.cos, np.sin)]
    columns = np.column_stack([evidence.penalty.linear_columns(evidence.best), *weight])
    return is_magnitude(columns, table.measured, (direction, *weight))


def _torque_with_velocity(evidence: Evidence) -> float | None:
    """Return the correlation of torque and velocity if the drive absorbs power from the joint, otherwise None.

    Friction can only dissipate power of the drive.
    """
    table = evidence.table
    torque = np.asarray(evidence.penalty.target) / table.duration
    power = float(np.mean(torque * table.velocity))
    level = float(np.sqrt(np.mean(torque**2) * np.mean(table.velocity**2)))
    return power / level if power < _AGAINST * level else None


def _flip_the_torque(evidence: Evidence) -> tuple[Action, ...]:
    """Return advice to flip the torque: by the gear ratio's sign on the motor side, otherwise when loading."""
    joint = evidence.joint
    if all(run.torque is not None for run in evidence.recordings):
        read_from = evidence.recordings[0].metadata.get(READ_FROM, "torque")
        return (_flipped(evidence, str(read_from)),)
    if joint is None or any(run.torque is not None for run in evidence.recordings):
        return ()
    return (Action("call", {"gear_ratio": -joint.gear_ratio}, function="Joint"),)


def _flipped(evidence: Evidence, signal: str) -> Action:
    """Return advice to read a signal with the other sign."""
    scaled = evidence.recordings[0].metadata.get("scale")
    factor = scaled.get(signal, 1.0) if isinstance(scaled, Mapping) else 1.0
    return Action("call", {"scale": {signal: -factor}}, function="load")


def _inertia_ratio(free: Unbounded, given: float) -> float | None:
    """Return the ratio of the inertia in the recording to the known one; None if they agree."""
    ratios = [free.values["inertia"] / given]
    reverse = free.with_noisy_sensor()
    if reverse is not None:
        ratios.append(reverse["inertia"] / given)
        hidden = 1.0 - free.values["sensor_gain"] / reverse["sensor_gain"] > _HIDDEN
        if hidden and 1.0 / GROSS < ratios[0] < GROSS:
            return None
    if min(ratios) < 1.0 < max(ratios):
        return None
    nearest = min(ratios, key=lambda ratio: abs(ratio - 1.0))
    return nearest if abs(nearest - 1.0) >= _SCALE else None


def _inertia_contradicts(evidence: Evidence, free: Unbounded) -> Iterator[Finding]:
    """Yield the finding of a contradicted inertia; a known inertia fixes the scale, so the recording must agree."""
    given = evidence.parameters.get("inertia")
    if given is None or given.vary or given.value == 0.0 or "inertia" not in free.values:
        return
    if free.relative > EXPLAINED:
        return  # another fault that changes the inertia
    ratio = _inertia_ratio(free, given.value)
    if ratio is None or not free.sure("inertia", given.value):
        return
    seen = (
        f"the log shows an inertia of {ratio * given.value:.4g} {given.unit}, "
        f"{ratio:.3g} times the known {given.value:.4g}"
    )
    measured = {
        "inertia": Measured(ratio * given.value, given.unit),
        "given_inertia": Measured(given.value, given.unit),
        "ratio": Measured(ratio),
    }
    corrections = tuple(corrections_of(evidence, ratio))
    if not corrections and 0.8 < ratio / _DEGREE < 1.25:
        yield IMPLAUSIBLE_UNITS.finding(
            seen,
            degrees_advice(evidence.recordings[0], ("position", "velocity")),
            details="this is the factor from degrees to radians",
            evidence=measured,
            parameters=("inertia",),
        )
        return
    yield WRONG_SCALE.finding(
        seen,
        *corrections,
        # No call that frees the inertia: with a wrong torque it would hide this finding, and all values stay wrong.
        Action(
            "inspect",
            text="gear ratio, torque constant, torque unit and inertia; correct the wrong one",
        ),
        details=f"{_gear_hint(evidence, ratio)}until this error is corrected, every value is wrong",
        evidence=measured,
        parameters=("inertia", *scaled_with_torque(evidence)),
    )


def scaled_with_torque(evidence: Evidence) -> tuple[str, ...]:
    """Return the free parameters that scale with the torque: all except shapes."""
    coefficients = evidence.penalty.names[: evidence.penalty.coefficients]
    return tuple(name for name in coefficients if evidence.parameters[name].vary)


def _gear_hint(evidence: Evidence, ratio: float) -> str:
    gear = abs(evidence.joint.gear_ratio) if evidence.joint is not None else 1.0
    hint = ""
    if gear > 1.0:
        for factor, verb in ((gear, "multiplied"), (1.0 / gear, "divided")):
            if 0.8 < ratio / factor < 1.25:
                hint = f"the torque seems {verb} by the gear ratio once too often; "
    return hint


def _sensor_reversed(evidence: Evidence, free: Unbounded) -> Iterator[Finding]:
    gain = evidence.parameters.get("sensor_gain")
    if gain is None or gain.min < 0.0 or "sensor_gain" not in free.values:
        return
    if free.values["sensor_gain"] < 0.0 and free.sure("sensor_gain", 0.0):
        yield REVERSED_SIGN.finding(
            "the sensor's sign is reversed: its reading falls where the link's torque rises",
            _flipped(evidence, "sensor"),
            evidence={"unbounded_gain": Measured(free.values["sensor_gain"], gain.unit)},
            parameters=("sensor_gain",),
        )


CHECK = Check(_find, (UNSIGNED_TORQUE, REVERSED_SIGN, IMPLAUSIBLE_UNITS, WRONG_SCALE))
