"""Section of a study: results of its trials as pictures, and one row per cell."""

from __future__ import annotations

from typing import cast

from jointid.base.result import Result
from jointid.panels.study import study_pictures
from jointid.report.page.content import Figure, Part, Table, paragraph
from jointid.report.page.extras import Extras
from jointid.study.study_result import Study
from jointid.study.summary import Summary, summary_notes, summary_texts


def content(result: Result, extras: Extras) -> list[Part]:
    """Return the pictures and then the table."""
    study = cast("Study", result)
    summary = study.summary()
    head, rows = summary_texts(summary)
    said = (_meaning(summary), *summary_notes(summary))
    figures = tuple(map(Figure, study_pictures(study)))
    table = Table(tuple(map(tuple, rows)), tuple(head))
    return [
        Part("", figures),
        Part("Each cell", (table, *map(paragraph, said)), f"{extras.prefix}cells"),
    ]


def _meaning(summary: Summary) -> str:
    """Return the meaning of the table's numbers."""
    if any(cell.bias for cell in summary.cells):
        return "Parameters: mean error ± standard deviation over the trials [% of the truth]."
    return "Parameters: mean ± standard deviation over the trials."
