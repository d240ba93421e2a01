"""Section with the expected errors of a designed motion."""

from __future__ import annotations

from typing import cast

from jointid.base.result import Result
from jointid.excitation.design import Design
from jointid.excitation.tables import share_text
from jointid.report.page.content import Part, Run, Table, paragraph
from jointid.report.page.extras import Extras
from jointid.report.page.wording import value_cell


def content(result: Result, extras: Extras) -> list[Part]:
    """Return the table: value, expected error and unit in one cell."""
    design = cast("Design", result)
    quantities = extras.overview.parameters
    columns = {"value ± expected error": [value_cell(each) for each in quantities]}
    errors = design.parameters.values()
    columns["at worst"] = [share_text(each.worst) for each in errors]
    if any(each.before is not None for each in errors):
        columns["before"] = [
            "–" if each.before is None else f"± {each.before:.2g}" for each in errors
        ]
    if design.reference:
        shares = (design.reference.get(name) for name in design.parameters)
        columns["thesis's motion"] = ["–" if each is None else share_text(each) for each in shares]
    rows: list[tuple[Run, ...]] = [
        (each.name, *cells) for each, *cells in zip(quantities, *columns.values(), strict=True)
    ]
    table = Table(tuple(rows), ("parameter", *columns))
    said = paragraph("Expected standard errors for one recording of this motion.", muted=True)
    return [Part("Expected errors", (table, said), f"{extras.prefix}errors", "half")]
