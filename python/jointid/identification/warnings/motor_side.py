"""Values that are on the motor's side, because nobody said the gear ratio."""

from collections.abc import Iterator

from jointid.base.advice import Action
from jointid.estimate.findings import Finding
from jointid.identification.warnings.check import Check, FindingType
from jointid.identification.warnings.evidence import Evidence

MOTOR_SIDE = FindingType(
    code="motor_side",
    severity="info",
    meaning="the columns are the motor's and no gear ratio is known: all values are on the motor's side of the gear",
    advice="nothing, if that side is meant; else give the gear ratio when loading",
)


def _find(evidence: Evidence) -> Iterator[Finding]:
    if any(recording.metadata.get("side") == "motor" for recording in evidence.recordings):
        ratio = "the motor's angle per angle of the joint"
        yield MOTOR_SIDE.finding(
            "no gear ratio is known: the values are on the motor's side",
            Action("call", {"gear_ratio": ...}, ratio, "load"),
        )


CHECK = Check(_find, (MOTOR_SIDE,))
