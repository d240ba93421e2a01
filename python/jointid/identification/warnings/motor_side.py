"""Values on the motor side, because no gear ratio is known."""

from collections.abc import Iterator

from jointid.base.advice import Action
from jointid.estimate.findings import Finding
from jointid.identification.warnings.check import Check, FindingType
from jointid.identification.warnings.evidence import Evidence
from jointid.identification.warnings.inspection import Inspected
from jointid.recording.recording import Recording

MOTOR_SIDE = FindingType(
    code="motor_side",
    severity="info",
    meaning="no gear ratio is known, so all values are on the motor side. Or motor torque or current is used with a "
    "gear ratio of 1. Blocking: the joint has a gear ratio, but the log was read without this ratio",
    advice="state the gear ratio. Do nothing if you want motor-side values, or if the motor has no gear",
)
_CLOSE = 0.03  # of the gear ratio
_RATIO = "motor angle per joint angle"


def _in_recording(evidence: Evidence, inspected: Inspected) -> Iterator[Finding]:
    at_motor = inspected.recording.metadata.get("side") == "motor"
    ratio = 1.0 if evidence.joint is None else evidence.joint.gear_ratio
    if at_motor and ratio != 1.0:
        yield MOTOR_SIDE.finding(
            f"the log was read without the gear ratio of {ratio:g}: the values are on the motor side",
            Action("call", {"gear_ratio": ratio}, function="load"),
            severity="blocking",
        )
    elif at_motor:
        yield MOTOR_SIDE.finding(
            "no gear ratio is known: the values are on the motor side",
            Action("call", {"gear_ratio": ...}, _RATIO, "load"),
        )
    elif _without_gear(evidence, inspected.recording):
        yield MOTOR_SIDE.finding(
            "motor torque or current is used with a gear ratio of 1",
            Action("call", {"gear_ratio": ...}, _RATIO, "Joint"),
        )


def _without_gear(evidence: Evidence, run: Recording) -> bool:
    joint = evidence.joint
    if joint is None or joint.gear_ratio != 1.0:
        return False
    return run.torque is None and (run.motor_torque is not None or run.current is not None)


def other_side(ratio: float | None, factor: float) -> tuple[str, Action] | None:
    """Return the signal on the other side of the gear, and its advice; None if no gear explains the factor.

    Parameters
    ----------
    ratio : float or None
        Gear ratio, if known.
    factor : float
        The position's change over the integral of the velocity.
    """
    if ratio is None or abs(abs(ratio) - 1.0) < _CLOSE:
        return None
    for signal, expected in (("velocity", 1.0 / ratio), ("position", ratio)):
        if abs(factor / expected - 1.0) < _CLOSE:
            return signal, _on_motor(signal, ratio)
    return None


def possible_side(factor: float) -> Action:
    """Return the advice to read the faster of two signals as the motor's, with the ratio of their rates."""
    signal, ratio = ("velocity", 1.0 / factor) if abs(factor) < 1.0 else ("position", factor)
    return _on_motor(signal, float(f"{ratio:.4g}"), f"if the {signal} is the motor's")


def _on_motor(signal: str, ratio: float, text: str = "") -> Action:
    return Action("call", {"side": {signal: "motor"}, "gear_ratio": ratio}, text, "load")


def known_ratio(evidence: Evidence) -> float | None:
    """Return the gear ratio of the joint, otherwise of a recording; None if none states it."""
    if evidence.joint is not None and evidence.joint.gear_ratio != 1.0:
        return evidence.joint.gear_ratio
    stated = [run.metadata.get("gear_ratio") for run in evidence.recordings]
    return next((float(each) for each in stated if isinstance(each, int | float)), None)


CHECK = Check(None, (MOTOR_SIDE,), _in_recording)
