"""Section with the tracking error of a session's runs."""

from __future__ import annotations

from typing import TYPE_CHECKING, cast

from jointid.base.result import Result
from jointid.estimate.overview import quantity_of
from jointid.panels.session import tracking
from jointid.report.page.content import Figure, Part, Table, paragraph, table_of
from jointid.report.page.extras import Extras
from jointid.report.page.wording import value_cell

if TYPE_CHECKING:
    from jointid.commissioning.result import Commissioning


def content(result: Result, extras: Extras) -> list[Part]:
    """Return picture and table of the runs, and the assumed and identified values."""
    from jointid.commissioning.result import run_rows

    session = cast("Commissioning", result)
    what = paragraph("Measured with the encoder, without the first sixth of each run.", muted=True)
    prefix = extras.prefix
    parts = [Part("Tracking error", (Figure(tracking(session)),), f"{prefix}tracking", "half")]
    if session.estimates:
        table = _identified(session)
        parts.append(Part("Assumed and identified", (table,), f"{prefix}identified", "half"))
    return [*parts, Part("Runs", (table_of(run_rows(session)), what), f"{prefix}runs")]


def _identified(session: Commissioning) -> Table:
    """Return the assumed values and those of the last cycle, with the truth of an emulated joint."""
    from jointid.commissioning.result import parameter_rows

    head, *rows = parameter_rows(session)
    found = session.estimates[-1].parameters
    named = ["identified", "assumed", *(["truth", "error"] if session.truth else [])]
    kept = [1, *((len(head) - 2, len(head) - 1) if session.truth else ())]
    cells = []
    for name, *others in rows:
        assumed, *truth = (others[column - 1] for column in kept)
        cells.append((name, value_cell(quantity_of(found[name])), assumed, *truth))
    return Table(tuple(cells), ("parameter", *named))
