"""Columns of the file that a header assigns to a signal and that were not read."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from jointid.base.advice import Action
from jointid.estimate.findings import Finding
from jointid.identification.warnings.check import Check, FindingType
from jointid.identification.warnings.evidence import Evidence
from jointid.identification.warnings.inspection import Inspected

LEFT_OUT = FindingType(
    code="left_out",
    severity="info",
    meaning="a column has the name of a signal, but another unit, cells that are no numbers, or stands beside a "
    "column that is read: it is not read",
    advice="nothing, if the signal is not needed; else name the column, its unit or its scale when loading",
)
INTERPOLATED = FindingType(
    code="interpolated",
    severity="info",
    meaning="the file has a signal at a lower rate than the others; it was interpolated linearly at their samples",
    advice="record all signals with one period",
)
_SHOWN = 6


def _in_recording(_: Evidence, inspected: Inspected) -> Iterator[Finding]:
    metadata = inspected.recording.metadata
    left_out = metadata.get("left_out")
    columns = {
        str(each.get("column")): str(each.get("reason"))
        for each in (left_out if isinstance(left_out, list | tuple) else ())
        if isinstance(each, Mapping)
    }
    if columns:
        shown = [f"{column} ({reason})" for column, reason in list(columns.items())[:_SHOWN]]
        more = f" and {len(columns) - _SHOWN} more" if len(columns) > _SHOWN else ""
        yield LEFT_OUT.finding(
            f"not read from the file: {', '.join(shown)}{more}",
            Action(
                "inspect",
                text="the headers, and name the column or its unit if the signal is needed",
            ),
        )
    interpolated = _pairs(metadata.get("interpolated"))
    if interpolated:
        shown = [f"{column} (every {period})" for column, period in interpolated]
        yield INTERPOLATED.finding(
            f"interpolated at the other signals' samples: {', '.join(shown)}",
            Action("record", text="all signals with one period"),
        )


def _pairs(value: object) -> tuple[tuple[object, object], ...]:
    return tuple(value.items()) if isinstance(value, Mapping) else ()


CHECK = Check(None, (LEFT_OUT, INTERPOLATED), _in_recording)
