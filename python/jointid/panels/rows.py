"""Named rows of a comparison, below each other: a value with its error, and single values."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from jointid.base.values import dataclass
from jointid.panels.marks import Line, Mark, Panel, Points, numbers, row_height


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class NamedRow:
    """One named row of a picture.

    Attributes
    ----------
    name : str
    value : float
        Value; NaN if there is none.
    error : float
        Half the length of the error bar. Default: no bar.
    single : array_like
        Single values that `value` summarizes. Default: none.
    chosen : bool
        Whether the row has the colour of the result. Default False.
    """

    name: str
    value: float
    error: float = 0.0
    single: ArrayLike = ()
    chosen: bool = False


def rows_panel(
    rows: Sequence[NamedRow],
    across: str,
    what: str,
    labels: tuple[str, str, str],
    *,
    logarithmic: bool = False,
) -> Panel:
    """Return a panel of these rows.

    Parameters
    ----------
    rows : sequence of NamedRow
    across, what : str
        Label of the axis with its unit, and description of the rows.
    labels : tuple of str
        Labels in the legend for single values, values, and the chosen ones; "" for none.
    logarithmic : bool
        Whether the horizontal axis is logarithmic. Default False.
    """
    marks: list[Mark] = []
    single = [numbers(row.single) for row in rows]
    places = [np.full(each.size, -float(k)) for k, each in enumerate(single)]
    if any(each.size for each in single):
        marks.append(
            Points(
                look="measured",
                label=labels[0],
                across=np.concatenate(single),
                up=np.concatenate(places),
            )
        )
    for chosen, look, label in ((False, "second", labels[1]), (True, "fitted", labels[2])):
        mine = [(k, row) for k, row in enumerate(rows) if row.chosen == chosen]
        if not mine:
            continue
        values = np.array([row.value for _, row in mine])
        errors = np.array([row.error for _, row in mine])
        up = np.array([-float(k) for k, _ in mine])
        gaps = np.full(len(mine), np.nan)
        # A short vertical stroke marks the value: it is visible next to points, and without an error.
        bars = np.column_stack([values - errors, values + errors, gaps]).ravel()
        strokes = np.column_stack([values, values, gaps]).ravel()
        heights = np.column_stack([up - 0.14, up + 0.14, gaps]).ravel()
        if errors.any():
            marks.append(Line(look=look, across=bars, up=np.repeat(up, 3)))
        marks.append(Line(look=look, label=label, across=strokes, up=heights))
    names = tuple(row.name for row in rows)
    return Panel(
        across=across,
        up=what,
        height=row_height(len(rows)),
        marks=tuple(marks),
        names=names,
        logarithmic_across=logarithmic,
    )
