"""A torque or sensor that stays at its largest value."""

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
    meaning="the torque is at its limit in more than 1 % of the samples, and reaches this limit "
    "more than once. Steps of a torque command do not count as saturation",
    advice=f"record the torque that the drive applied, or record motion with less torque{DESIGNED}",
)
SENSOR_CLIPPED = FindingType(
    code="sensor_clipped",
    meaning="the sensor is at its limit in more than 1 % of the samples, and reaches this limit more than once",
    advice=f"widen the sensor's range, or record motion with a smaller load on the link{DESIGNED}",
)
_CLIPPED = 0.01  # share of the samples at a limit
_MUCH, _MISSED = (
    0.05,
    0.03,
)  # of the samples, and of the torque: above both, only the log was clipped, not the torque
_INSIDE = 0.9  # of the sensor's range
_FEWEST = 3  # samples: in a short log the largest sample alone exceeds one percent
_PASSAGES = 2  # number in all recordings together
_LASTING = 1.5  # samples per passage: equal peaks of a repeated motion are single samples
_HEAPED = 0.3  # share of the samples near a limit that are at the limit; a smooth peak has only one
_STEP = 0.9  # of the samples: with more at the limit, the signal is a command and not clipped
_SAME = 1e-6  # of the value
_BEYOND = 1e-3  # of the value: if another recording exceeds it by this, it is no limit


def _on_a_limit(evidence: Evidence, inspected: Inspected, name: str) -> float:
    """Return the share of the samples at a limit that clips the signal."""
    counts, samples = inspected.counts(name), len(inspected.recording)
    if counts.lowest == counts.highest:
        return 0.0
    share = 0.0
    for limit, value in ((counts.upper, counts.highest), (counts.lower, counts.lowest)):
        # At rest a clean signal is constant, and this may be its largest value.
        rests = (
            limit.there > _HEAPED * limit.near
            if counts.fine
            else limit.moving > 3 * (limit.near - limit.there)
        )
        # The magnitude of a torque stays at 0 where its sign changes.
        if rests and value and limit.moving >= _FEWEST:
            share += limit.moving / samples if _is_reached_again(evidence, name, value) else 0.0
    # A signal with few levels (a square wave) stays at its limits, like a step.
    changing = counts.changes > 0.3 * (1.0 - share) * (samples - 1)
    return share if changing and share < _STEP else 0.0


def _is_reached_again(evidence: Evidence, name: str, value: float) -> bool:
    """Return whether a signal returns to an extreme value in any recording, and exceeds it in none."""
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
    """Return the torque at the sensor just inside its range [N·m]; None without a gain."""
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
                # This advice is not the first, because a design cannot always keep the sensor's range.
                Action(
                    "inspect", text="the sensor's range, and widen this range or load the link less"
                ),
                other_motion(
                    evidence,
                    "motion with a smaller load on the link",
                    sensor_range=_sensed(evidence, signal),
                ),
                details="the true torque is larger in these samples",
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
                details=(
                    f"the model does not explain {percent(missed)} of the torque; "
                    if clipped
                    else ""
                )
                + "if only the log was clipped and not the torque, every value is wrong",
                evidence={
                    "clipped": Measured(share),
                    "limit": Measured(limit, unit),
                    "missed": Measured(missed),
                },
                severity="blocking" if clipped else None,
            )


CHECK = Check(None, (TORQUE_SATURATED, SENSOR_CLIPPED), _in_recording)
