"""A joint that stands still for too much of the recording, or hardly moves."""

from collections.abc import Iterator

from jointid.base.advice import Action
from jointid.estimate.findings import Finding, Measured
from jointid.identification.warnings.check import Check, FindingType
from jointid.identification.warnings.evidence import Evidence
from jointid.identification.warnings.inspection import Inspected
from jointid.identification.warnings.motion_advice import DESIGNED, other_motion
from jointid.recording.motion import WIDER, SmallMotion, small_motion

STANDING = FindingType(
    code="standing",
    meaning="the joint stands still or sticks in more than 35 % of the samples",
    advice=f"record more motion{DESIGNED}",
)
HARDLY_MOVES = FindingType(
    code="hardly_moves",
    severity="blocking",
    meaning="the whole motion is less than 50 encoder counts, or is only noise. Such a motion causes other "
    "findings, too",
    advice="record a wider motion",
)
_MUCH = 0.35


def _in_recording(evidence: Evidence, inspected: Inspected) -> Iterator[Finding]:
    recording = inspected.recording
    small = small_motion(recording)
    if small is not None:
        unit = recording.unit("position")
        yield HARDLY_MOVES.finding(
            small.text,
            Action("record", text=WIDER),
            details=small.details,
            evidence={"travel": Measured(small.travel, unit)} | _of(small, unit),
            parameters=tuple(name for name, each in evidence.parameters.items() if each.vary),
        )


def _find(evidence: Evidence) -> Iterator[Finding]:
    share = evidence.residuals.standing
    if share > _MUCH:
        yield STANDING.finding(
            f"the joint stands still or sticks in {100.0 * share:.0f} % of the samples",
            other_motion(evidence, "more motion"),
            details="these samples do not show friction and are left out",
            evidence={"standing": Measured(share)},
        )


def _of(small: SmallMotion, unit: str) -> dict[str, Measured]:
    if small.noise > 0.0:
        return {"noise": Measured(small.noise, unit)}
    return {
        "step": Measured(small.step, unit),
        "steps": Measured(small.steps),
        "unchanged": Measured(small.unchanged),
    }


CHECK = Check(_find, (STANDING, HARDLY_MOVES), _in_recording)
