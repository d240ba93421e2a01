"""How a log of messages was read, where that is not as everybody expects it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from jointid.base.advice import Action
from jointid.estimate.findings import Finding, Measured
from jointid.identification.warnings.check import Check, FindingType
from jointid.identification.warnings.evidence import Evidence
from jointid.identification.warnings.inspection import Inspected
from jointid.recording.file_remarks import remarks

MESSAGE_LOG = FindingType(
    code="message_log",
    severity="info",
    meaning="a file was read otherwise than as it stands: damaged or repeated rows, or a cut last line, are left out; "
    "stamps, units or sides are other than the file states; a log of messages is "
    "unfinished, has no stamps of its own, or repeated or late messages; or a file holds "
    "objects that are not read, or channels that end before the others",
    advice="nothing, if that is known; else record again, with stamps taken where the samples are",
)


def _in_recording(_: Evidence, inspected: Inspected) -> Iterator[Finding]:
    metadata = inspected.recording.metadata
    found = remarks(metadata) if isinstance(metadata, Mapping) else []
    if found:
        yield MESSAGE_LOG.finding(
            "; ".join(found),
            Action("inspect", text="the recorder, if that is not on purpose"),
            evidence={
                name: Measured(count)
                for name in ("repeated_messages", "reordered_messages")
                if (count := _count(metadata.get(name)))
            },
        )


def _count(value: object) -> int:
    return value if isinstance(value, int) else 0


CHECK = Check(None, (MESSAGE_LOG,), _in_recording)
