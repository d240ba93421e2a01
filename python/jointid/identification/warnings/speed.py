"""Motion that is too fast, too wide or too slow for a joint: probably degrees as radians, or another unit of time."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np

from jointid.base.advice import Action
from jointid.estimate.findings import Finding, Measured, Severity
from jointid.identification.warnings.check import Check
from jointid.identification.warnings.evidence import Evidence
from jointid.identification.warnings.inspection import Inspected
from jointid.identification.warnings.units import IMPLAUSIBLE_UNITS, degrees_advice
from jointid.identification.warnings.velocity import MISMATCH
from jointid.recording.order_statistics import quantile_of_sizes
from jointid.recording.plausibility import slow_stamps
from jointid.recording.recording import Recording

_MOTOR_SPEED = 2000.0  # [rad/s]: beyond any geared servo motor
_SWING = 25.0  # [rad] in both directions: four revolutions


def _in_recording(evidence: Evidence, inspected: Inspected) -> Iterator[Finding]:
    recording, peak = inspected.recording, inspected.found.peak_speed
    at_motor = _of_the_motor(recording)  # its speed is not multiplied by the ratio again
    gear = 1.0 if evidence.joint is None or at_motor else abs(evidence.joint.gear_ratio)
    if (slow := _slow_stamps(recording)) is not None:
        yield slow
        return
    agreement = inspected.found.agreement
    if recording.kind == "prismatic" or (
        agreement is not None and abs(agreement.scale - 1.0) > MISMATCH
    ):
        return  # contradictory signals have no speed, and this is already reported
    if gear > 1.0 and peak * gear > _MOTOR_SPEED:  # one outlier is not a speed
        peak = quantile_of_sizes(recording.velocity, 0.99)
    severity: Severity = "blocking"
    whole = bool(np.all(recording.position == np.rint(recording.position)))
    swing = inspected.found.swing
    travel = abs(float(recording.position[-1] - recording.position[0]))
    if gear > 1.0 and peak * gear > _MOTOR_SPEED:
        speed = peak * gear * 60.0 / (2.0 * np.pi)
        seen, shown = f"the motor would turn at {speed:.0f} rpm", Measured(speed, "rpm")
        measured = {"motor_speed": shown}
    elif swing > _SWING and travel < 0.5 * swing and not _of_the_motor(recording):
        turns = swing / (2.0 * np.pi)
        seen = f"the joint would swing through {turns:.0f} revolutions"
        measured = {"swing": Measured(turns, "turns")}
        if not whole:
            severity = _of_many_turns(recording, agrees=agreement is not None)
    else:
        return
    if severity == "info":
        yield IMPLAUSIBLE_UNITS.finding(
            f"{seen}; a wheel or a spindle can do this",
            details="if the joint has stops, the position is probably in degrees",
            evidence=measured,
            severity=severity,
        )
        return
    signals = ("position",) if recording.velocity_derived else ("position", "velocity")
    details = "the gear ratio may also be wrong"
    if evidence.joint is not None and "motor_speed" in measured and _is_converted(recording):
        sides = {"side": dict.fromkeys(signals, "motor"), "gear_ratio": evidence.joint.gear_ratio}
        yield IMPLAUSIBLE_UNITS.finding(
            f"{seen}: the position is probably the motor angle",
            Action("call", sides, "if the position is the motor angle", "load"),
            Action("inspect", text="the unit of the position and the gear ratio"),
            details=details,
            evidence=measured,
            severity=severity,
        )
        return
    advice = [degrees_advice(recording, signals)]
    if whole:
        details = "all positions are whole numbers and may also be encoder counts; " + details
        scale = dict.fromkeys(signals, ...)
        advice.append(
            Action("call", {"scale": scale}, "2π divided by the counts per revolution", "load")
        )
    yield IMPLAUSIBLE_UNITS.finding(
        f"{seen}: the position is probably in degrees",
        *advice,
        Action("inspect", text="the gear ratio"),
        details=details,
        evidence=measured,
        severity=severity,
    )


def _of_many_turns(recording: Recording, *, agrees: bool) -> Severity:
    """Return the severity of a wide motion: low for stated units, because no guess overrides them.

    Parameters
    ----------
    agrees : bool
        Whether a recorded velocity agrees with the position's derivative.
    """
    assumed = recording.metadata.get("assumed_units")
    unstated = set(assumed) if isinstance(assumed, list | tuple) else set()
    if "position" not in unstated or (agrees and "velocity" not in unstated):
        return "info"
    return "blocking"  # two columns with the same wrong unit also agree


def _of_the_motor(recording: Recording) -> bool:
    """Return whether the position is that of a motor without a known gear ratio, which may turn many times."""
    return recording.metadata.get("side") == "motor"


def _is_converted(recording: Recording) -> bool:
    """Return whether the position was converted to radians, by a unit or a factor: it is then not in degrees."""
    scale, stated = (recording.metadata.get(name) for name in ("scale", "stated_sides"))
    of_motor = isinstance(stated, Mapping) and stated.get("position") == "motor"
    return isinstance(scale, Mapping) and "position" in scale and not of_motor


def _slow_stamps(recording: Recording) -> Finding | None:
    found = slow_stamps(recording.sample_period)
    if found is None:
        return None
    return IMPLAUSIBLE_UNITS.finding(
        found[0],
        Action("call", {"units": {"time": found[1]}}, function="load"),
        evidence={"sample_period": Measured(recording.sample_period, "s")},
    )


CHECK = Check(None, (IMPLAUSIBLE_UNITS,), _in_recording)
