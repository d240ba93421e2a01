"""How well a session's runs followed their reference."""

from __future__ import annotations

from typing import TYPE_CHECKING, cast

from jointid.base.result import Result
from jointid.panels.session import tracking
from jointid.report.page.content import Figure, Part, paragraph, table_of
from jointid.report.page.extras import Extras

if TYPE_CHECKING:
    from jointid.commissioning.result import Commissioning


def content(result: Result, extras: Extras) -> list[Part]:
    """Picture and table of the runs; what was assumed and what was identified."""
    from jointid.commissioning.result import parameter_rows, run_rows

    session = cast("Commissioning", result)
    what = paragraph("By the encoder, without the first sixth of each run.", muted=True)
    prefix = extras.prefix
    parts = [
        Part("Tracking error", (Figure(tracking(session)),), f"{prefix}tracking", "half"),
        Part("Runs", (table_of(run_rows(session)), what), f"{prefix}runs", "half"),
    ]
    if session.estimates:
        table = table_of(parameter_rows(session))
        parts.append(Part("Assumed and identified", (table,), f"{prefix}identified"))
    return parts
