"""Unexpected conversions of a message log while it was read."""

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
    meaning="the file was not read exactly as written: rows or messages are damaged, repeated, late or left out. Or "
    "`jointid` uses other time stamps, units or sides than the file states",
    advice="check the recorder. Do nothing if you expect these differences",
)
_ROOM = 65  # characters of a title, without the number of recordings


def _in_recording(_: Evidence, inspected: Inspected) -> Iterator[Finding]:
    metadata = inspected.recording.metadata
    found = remarks(metadata) if isinstance(metadata, Mapping) else []
    if found:
        title, *why = found[0].split(": ", 1) if len(found[0]) > _ROOM else found[:1]
        yield MESSAGE_LOG.finding(
            title,
            Action("inspect", text="the recorder, if you do not expect this"),
            details="; ".join([*why, *found[1:]]),
            evidence={
                name: Measured(count)
                for name in ("repeated_messages", "reordered_messages")
                if (count := _count(metadata.get(name)))
            },
        )


def _count(value: object) -> int:
    return value if isinstance(value, int) else 0


CHECK = Check(None, (MESSAGE_LOG,), _in_recording)
