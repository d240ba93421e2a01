"""A torque or a sensor that rests on its largest value."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from jointid import _core
from jointid.base.advice import Action
from jointid.estimate.findings import Finding, Measured
from jointid.estimate.wording import percent
from jointid.identification.warnings.check import Check, FindingType
from jointid.identification.warnings.evidence import Evidence
from jointid.identification.warnings.inspection import DRIVE, Inspected
from jointid.identification.warnings.motion_advice import DESIGNED, other_motion

TORQUE_SATURATED = FindingType(
    code="torque_saturated",
    meaning="the torque is at its limit in more than 1 % of the samples, and reaches it more than once. "
    "A commanded step is not a limit",
    advice=f"record gentler motion, or record the torque that the drive applied{DESIGNED}",
)
SENSOR_CLIPPED = FindingType(
    code="sensor_clipped",
    meaning="the sensor is at its limit in more than 1 % of the samples, and reaches it more than once",
    advice=f"widen the sensor's range, or load the link less{DESIGNED}",
)
_CLIPPED = 0.01  # share of the samples on a limit
_MUCH, _MISSED = (
    0.05,
    0.03,
)  # of the samples, and of the torque: the record was clipped, not the torque
_INSIDE = 0.9  # of the sensor's range
_FEWEST = 3  # samples: the largest of a short log is one in a hundred
_PASSAGES = 2  # in all recordings together
_LASTING = 1.5  # samples a passage: equal peaks of a motion that repeats itself are single samples
_HEAPED = 0.3  # of the samples near a limit lie on it; a smooth peak has but one there
_STEP = 0.9  # of the samples: so long rests what is commanded, not what is cut off
_SAME = 1e-6  # of the value
_BEYOND = 1e-3  # of the value: another recording goes further, so it is no limit


def _on_a_limit(evidence: Evidence, inspected: Inspected, name: str) -> float:
    """Share of the samples that lie on a limit which cuts the signal off."""
    counts, samples = inspected.counts(name), len(inspected.recording)
    if counts.lowest == counts.highest:
        return 0.0
    share = 0.0
    for limit, value in ((counts.upper, counts.highest), (counts.lower, counts.lowest)):
        # At rest a clean signal stays where it is, and that may be its largest value.
        rests = (
            limit.there > _HEAPED * limit.near
            if counts.fine
            else limit.moving > 3 * (limit.near - limit.there)
        )
        # The magnitude of a torque that has lost its sign rests on 0 where it changes.
        if rests and value and limit.moving >= _FEWEST:
            share += limit.moving / samples if _is_reached_again(evidence, name, value) else 0.0
    # A signal of few levels (a square wave) rests on its limits by nature, as a step does.
    changing = counts.changes > 0.3 * (1.0 - share) * (samples - 1)
    return share if changing and share < _STEP else 0.0


def _is_reached_again(evidence: Evidence, name: str, value: float) -> bool:
    """Whether a signal comes back to an extreme value in one recording or another, and goes beyond it in none."""
    passages = samples = 0
    for inspected in evidence.inspections:
        if name not in inspected.channels:
            continue
        counts, signal = inspected.counts(name), getattr(inspected.recording, name)
        farthest = counts.highest if value > 0.0 else counts.lowest
        if farthest * np.sign(value) > (1.0 + _BEYOND) * abs(value):
            return False
        there = np.abs(np.abs(signal) - abs(value)) <= _SAME * abs(value)
        passages += int(there[0]) + int(np.count_nonzero(there[1:] & ~there[:-1]))
        samples += int(np.count_nonzero(there))
    return passages >= _PASSAGES and samples >= _LASTING * passages


def _sensed(evidence: Evidence, counts: _core.SignalFacts) -> float | None:
    """The torque at the sensor just inside its range [N·m]; None without a gain."""
    found = evidence.parameters
    if "sensor_gain" not in found:
        return None
    gain, offset = found["sensor_gain"].value, found["sensor_offset"].value
    torques = [gain * limit + offset for limit in (counts.lowest, counts.highest)]
    return _INSIDE * min(abs(torque) for torque in torques)


def _in_recording(evidence: Evidence, inspected: Inspected) -> Iterator[Finding]:
    recording = inspected.recording
    for name in inspected.channels:
        if name not in (*DRIVE, "sensor"):
            continue
        signal = inspected.counts(name)
        share = _on_a_limit(evidence, inspected, name)
        if share < _CLIPPED:
            continue
        if name == "sensor":
            yield SENSOR_CLIPPED.finding(
                f"the sensor is at its limit in {percent(share)} of the samples",
                # A design cannot always keep the sensor's range, so it does not stand first.
                Action("inspect", text="the sensor's range: widen it, or load the link less"),
                other_motion(
                    evidence,
                    "motion with a smaller load on the link",
                    sensor_range=_sensed(evidence, signal),
                ),
                details="the true torque is larger there",
                evidence={"clipped": Measured(share)},
                parameters=evidence.sensor_parameters,
            )
        else:
            both = ((signal.upper.moving, signal.highest), (signal.lower.moving, signal.lowest))
            limit = max(both)[1]
            unit = recording.unit(name)
            missed = evidence.residuals.relative
            clipped = share > _MUCH and missed > _MISSED
            yield TORQUE_SATURATED.finding(
                f"{name} is at its limit of {limit:.4g} {unit} in {percent(share)} of the samples",
                other_motion(evidence, "gentler motion", gentler=True),
                Action("record", text="the torque that the drive applied"),
                details=(f"the model misses {percent(missed)} of the torque; " if clipped else "")
                + "if only the log was clipped and not the torque, every value is wrong",
                evidence={
                    "clipped": Measured(share),
                    "limit": Measured(limit, unit),
                    "missed": Measured(missed),
                },
                severity="blocking" if clipped else None,
            )


CHECK = Check(None, (TORQUE_SATURATED, SENSOR_CLIPPED), _in_recording)
