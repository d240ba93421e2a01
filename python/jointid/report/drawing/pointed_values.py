"""Values under the pointer, without a script: strips over a picture, each with its values as title."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from jointid.base.html import Html, element
from jointid.panels.marks import Bars, Line, Mark, Panel, Points, numbers
from jointid.report.drawing.scale import Scale, drawable

Array = NDArray[np.float64]

_STRIPS = 80


def readouts(panels: Sequence[Panel], across: Scale, top: int, foot: int) -> list[Html]:
    """Return strips that cover panels with one horizontal axis. Each shows the values drawn there.

    A line is read in the middle of a strip. Points give the nearest point in the strip, and bars the bar there.

    Parameters
    ----------
    panels : sequence of Panel
        The panels. Panels with named rows have no numbers to read.
    across : Scale
    top, foot : int
        Upper and lower end of the panels [tenths of a unit].

    Returns
    -------
    list of Html
        The strips; empty if nothing is drawn.
    """
    to, back = (np.log, np.exp) if across.logarithmic else (np.asarray, np.asarray)
    low, high = to(numbers([across.low, across.high])).tolist()
    edges = np.linspace(low, high, _STRIPS + 1)
    middles = 0.5 * (edges[1:] + edges[:-1])
    read = [
        (mark.label, up, _values(mark, middles, float(edges[1] - edges[0]), to))
        for panel in panels
        if not panel.names
        for marks, up in ((panel.marks, panel.up), (panel.right, panel.right_up))
        for mark in marks
    ]
    columns = [
        (*_named(label, up), values.tolist()) for label, up, values in read if values is not None
    ]
    name, unit = _named("", panels[-1].across)
    places = across.places(back(edges)).tolist()
    strips = []
    for number, middle in enumerate(back(middles).tolist()):
        said = [
            f"{label}: {_shown(values[number])}{unit}"
            for label, unit, values in columns
            if math.isfinite(values[number])
        ]
        if not said:
            continue
        title = "\n".join([f"{name}: {_shown(middle)}{unit}", *said])
        left, right = places[number : number + 2]
        path = f"M{left} {foot}V{top}H{right}V{foot}z"
        strips.append(element("path", element("title", title), class_="readout", d=path))
    return strips


def _values(mark: Mark, middles: Array, width: float, to: Callable[[Array], Array]) -> Array | None:
    """Return a mark's value in each strip; NaN without a value, None for a mark that has no values to show."""
    if isinstance(mark, Bars):
        edges, up = to(numbers(mark.edges)), numbers(mark.up)
        if len(up) == 0:
            return None
        place = np.searchsorted(edges, middles, side="right") - 1
        inside = (place >= 0) & (place < len(up))
        return np.where(inside, up[np.clip(place, 0, len(up) - 1)], np.nan)
    if not isinstance(mark, Line | Points):
        return None
    x, y = to(numbers(mark.across)), numbers(mark.up)
    if isinstance(mark, Line):
        return _on_a_line(x, y, middles)
    known = drawable(x) & drawable(y)
    order = np.argsort(x[known], kind="stable")
    return _nearest(x[known][order], y[known][order], middles, width)


def _on_a_line(x: Array, y: Array, middles: Array) -> Array | None:
    """Return the values of a line between its points; NaN in gaps, None if it passes a place more than once."""
    known = drawable(x) & drawable(y)
    if not known.any() or (np.diff(x[known]) < 0.0).any():
        return None
    values = np.interp(middles, x[known], y[known], left=np.nan, right=np.nan)
    # A gap has no position: the interval between its neighbours belongs to it.
    inside = np.flatnonzero(known)
    after = np.minimum(np.searchsorted(x[inside], middles), len(inside) - 1)
    before = np.maximum(after - 1, 0)
    return np.where(inside[after] - inside[before] > 1, np.nan, values)


def _nearest(x: Array, y: Array, middles: Array, width: float) -> Array | None:
    """Return the values of the nearest points in each strip; x must increase."""
    if len(x) == 0:
        return None
    after = np.minimum(np.searchsorted(x, middles), len(x) - 1)
    before = np.maximum(after - 1, 0)
    closer = np.abs(x[after] - middles) < np.abs(x[before] - middles)
    nearest = np.where(closer, after, before)
    near = np.abs(x[nearest] - middles) <= 0.5 * width
    return np.where(near, y[nearest], np.nan)


def _named(label: str, title: str) -> tuple[str, str]:
    """Return a mark's name and unit: its label, or the title of the axis."""
    shown, _, unit = title.partition(" [")
    unit = unit.removesuffix("]")
    return label or shown, f" {unit}" if unit and unit != "1" else ""


def _shown(value: float) -> str:
    return f"{value:.4g}".replace("-", "\u2212")
