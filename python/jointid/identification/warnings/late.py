"""Samples of a session that were late or lost, and commands that were not confirmed."""

from collections.abc import Iterator

from jointid.base.advice import Action
from jointid.estimate.findings import Finding, Measured
from jointid.estimate.wording import percent
from jointid.identification.warnings.check import Check, FindingType
from jointid.identification.warnings.evidence import Evidence
from jointid.identification.warnings.inspection import Inspected

LATE = FindingType(
    code="late_samples",
    severity="info",
    meaning="samples of a session were late or lost, or a command was not confirmed. The identification leaves "
    "these intervals out",
    advice="find out what delays the bus or the computer",
)


def _in_recording(_: Evidence, inspected: Inspected) -> Iterator[Finding]:
    recording = inspected.recording
    left_out = len(recording.doubtful)
    if recording.late is None or not left_out:
        return
    intervals = len(recording) - 1
    missing = int(recording.late[1:].astype(int).sum())
    yield LATE.finding(
        f"{left_out} of {intervals} intervals ({percent(left_out / intervals)}) have late or lost samples",
        Action("inspect", text="what delays the bus or the computer"),
        details=f"these intervals are left out: {missing} cycles are missing, or commands were not confirmed",
        evidence={
            "left_out": Measured(left_out),
            "intervals": Measured(intervals),
            "missing_cycles": Measured(missing),
        },
    )


CHECK = Check(None, (LATE,), _in_recording)
