"""Recordings with gaps."""

from collections.abc import Iterator

from jointid.base.advice import Action
from jointid.estimate.findings import Finding, Measured
from jointid.identification.warnings.check import Check, FindingType
from jointid.identification.warnings.evidence import Evidence
from jointid.identification.warnings.inspection import Inspected

GAPS = FindingType(
    code="gaps",
    severity="info",
    meaning="the time stamps jump: samples are missing. No window crosses a gap, so values are not affected",
    advice="find out why samples are missing",
)


def _in_recording(_: Evidence, inspected: Inspected) -> Iterator[Finding]:
    recording = inspected.recording
    if recording.gaps:
        longest = max(recording.gaps, key=lambda gap: gap.duration)
        yield GAPS.finding(
            f"gaps in the log: {len(recording.gaps)}; the longest lasts {longest.duration:.3g} s, from "
            f"{longest.start:.3f} s",
            Action("inspect", text="why samples are missing"),
            details="no window crosses a gap",
            evidence={
                "gaps": Measured(len(recording.gaps)),
                "longest": Measured(longest.duration, "s"),
                "start_of_longest": Measured(longest.start, "s"),
            },
        )


CHECK = Check(None, (GAPS,), _in_recording)
