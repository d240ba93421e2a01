"""The report of a comparison of models: the winner and why, then all of them, then what was identified with it."""

from __future__ import annotations

from collections.abc import Callable

from jointid.base.advice import Action
from jointid.base.html import Html, element, page, table
from jointid.comparison.result import HEAD, Comparison
from jointid.report.answering import answer, verdict_lines
from jointid.report.figure import captioned
from jointid.report.html import footer, sections
from jointid.report.rows import NamedRow, rows_panel
from jointid.report.style import STYLE

_DRAWN = 20  # models; the table has all


def comparison_report(comparison: Comparison, action: Callable[[Action], str] = str) -> str:
    """The report as one HTML page that needs no other file.

    Parameters
    ----------
    comparison : Comparison
    action : callable
        Words the advice of a finding. Default: as at a Python prompt.
    """
    estimate = comparison.estimate
    title = f"{estimate.joint.name or 'joint'}: {len(comparison.rows)} friction models compared by jointid"
    return page(
        title,
        STYLE,
        element("h1", title),
        answer(_first(comparison)),
        element("p", comparison.reason),
        element("h2", "How well each model predicts", id="models"),
        _picture(comparison),
        _table(comparison),
        *_left_out(comparison),
        element("p", comparison.setting()),
        element("h2", f"Identified with {comparison.winner}", id="identified"),
        *verdict_lines(estimate.verdict),
        *sections(estimate, action),
        footer(estimate),
    )


def _first(comparison: Comparison) -> str:
    blocking = [each for each in comparison.estimate.findings if each.severity == "blocking"]
    return f"Use {comparison.winner}." if not blocking else f"Use none: {blocking[0].cause}."


def _picture(comparison: Comparison) -> Html:
    rows = [
        NamedRow(
            name=row.model,
            value=100.0 * row.score,
            error=100.0 * row.stderr,
            single=[100.0 * score for score in row.fold_scores],
            chosen=row.model == comparison.winner,
        )
        for row in comparison.rows[:_DRAWN]
    ]
    more = len(comparison.rows) - len(rows)
    drawn = f" The first {_DRAWN} of {len(comparison.rows)} models." if more else ""
    return captioned(
        "Relative residual of motion that the model was not fitted to: smaller is better. A grey point is one part "
        f"that was held out, the stroke is the mean with its standard error.{drawn}",
        rows_panel(
            rows, "held-out residual [%]", "model", ("one part", "mean", "mean of the chosen model")
        ),
    )


def _table(comparison: Comparison) -> Html:
    rows: list[list[Html | str]] = [
        [element("th" if row.model == comparison.winner else "td", cells[0]), *cells[1:]]
        for row, cells in zip(comparison.rows, comparison.cells(), strict=True)
    ]
    return table(rows, head=list(HEAD))


def _left_out(comparison: Comparison) -> list[Html]:
    left = comparison.settings["left_out"].items()
    if not left:
        return []
    lines = [element("li", f"{model}: {reason}") for model, reason in left]
    return [element("p", "Not compared:"), element("ul", *lines)]
