"""Section with the values of a result: value, error and unit in one cell."""

from __future__ import annotations

from collections.abc import Mapping

from jointid.base.result import Result, kind_of
from jointid.report.page.content import Block, Part, Run, Table, paragraph
from jointid.report.page.extras import Extras
from jointid.report.page.wording import value_cell

_EXPLAINED = (
    "estimate",
    "servo",
    "online",
)  # the uncertainty section, or a joint file, describes their parameters


def content(result: Result, extras: Extras) -> list[Part]:
    """Return the table of the values. Empty columns are omitted."""
    quantities = extras.overview.parameters
    if not quantities:
        return []
    scattered = any(each.error for each in quantities)
    columns = {
        "value ± std. error" if scattered else "value": [value_cell(each) for each in quantities],
        "± systematic": [each.systematic for each in quantities],
        "remark": [each.remark for each in quantities],
    }
    if kind_of(result) not in _EXPLAINED:
        columns["meaning"] = [each.meaning for each in quantities]
    shown = {name: cells for name, cells in columns.items() if any(cells)}
    rows: list[tuple[Run, ...]] = [
        (each.name, *cells) for each, *cells in zip(quantities, *shown.values(), strict=True)
    ]
    return [
        Part(
            "Parameters",
            (Table(tuple(rows), ("parameter", *shown)), *_note(shown)),
            name=f"{extras.prefix}parameters",
            look="half",
        )
    ]


def _note(shown: Mapping[str, list[str]]) -> list[Block]:
    """Return the meaning of the two errors, if both are shown."""
    if "± systematic" not in shown:
        return []
    return [
        paragraph(
            "± std. error covers random noise. ± systematic covers errors that more data do not reduce; "
            "the table names their main source.",
            muted=True,
        )
    ]
