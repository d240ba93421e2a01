"""Columns of the file with a signal's name that were not read."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from jointid.base.advice import Action
from jointid.estimate.findings import Finding
from jointid.identification.warnings.check import Check, FindingType
from jointid.identification.warnings.evidence import Evidence
from jointid.identification.warnings.inspection import Inspected
from jointid.identification.warnings.undetermined import listed

LEFT_OUT = FindingType(
    code="left_out",
    severity="info",
    meaning="a column with the name of a signal was not read: the unit does not fit, the column has no numbers, "
    "or another column was read as this signal",
    advice="name the column, its unit or its scale when loading. Do nothing if you do not need the signal",
)
INTERPOLATED = FindingType(
    code="interpolated",
    severity="info",
    meaning="a signal has a lower sampling rate than the others. This signal was interpolated linearly",
    advice="record all signals with one sampling rate",
)
_SHOWN = 6
_ROOM = 45  # characters of names in a title


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
            f"columns not read: {listed(columns, _ROOM)}",
            Action("inspect", text="the header, and name the column or its unit if needed"),
            details=f"{', '.join(shown)}{more}",
        )
    interpolated = _pairs(metadata.get("interpolated"))
    if interpolated:
        shown = [f"{column} (every {period})" for column, period in interpolated]
        yield INTERPOLATED.finding(
            f"interpolated linearly: {listed(shown, _ROOM)}",
            Action("record", text="all signals with one sampling rate"),
            details="" if len(shown) == 1 else ", ".join(shown),
        )


def _pairs(value: object) -> tuple[tuple[object, object], ...]:
    return tuple(value.items()) if isinstance(value, Mapping) else ()


CHECK = Check(None, (LEFT_OUT, INTERPOLATED), _in_recording)
