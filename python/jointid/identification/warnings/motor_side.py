"""Values that are on the motor's side, because nobody said the gear ratio."""

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
    meaning="the columns are the motor's and no gear ratio is known: all values are on the motor's side of the gear; "
    "or the torque is made from the motor's with a gear ratio of 1, which is what a joint has that states none",
    advice="nothing, if that side is meant, or if the motor has no gear; else give the gear ratio",
)
_RATIO = "the motor's angle per angle of the joint"


def _in_recording(evidence: Evidence, inspected: Inspected) -> Iterator[Finding]:
    if inspected.recording.metadata.get("side") == "motor":
        yield MOTOR_SIDE.finding(
            "no gear ratio is known: the values are on the motor's side",
            Action("call", {"gear_ratio": ...}, _RATIO, "load"),
        )
    elif _without_gear(evidence, inspected.recording):
        yield MOTOR_SIDE.finding(
            "the torque is made from the motor's with a gear ratio of 1, as without a gear",
            Action("call", {"gear_ratio": ...}, _RATIO, "Joint"),
        )


def _without_gear(evidence: Evidence, run: Recording) -> bool:
    joint = evidence.joint
    if joint is None or joint.gear_ratio != 1.0:
        return False
    return run.torque is None and (run.motor_torque is not None or run.current is not None)


CHECK = Check(None, (MOTOR_SIDE,), _in_recording)
