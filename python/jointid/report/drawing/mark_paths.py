"""SVG paths for each kind of mark on two scales."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from jointid.base.html import Html, element
from jointid.panels.marks import Band, Bars, Level, Line, Mark, Points, Range, Shade, numbers
from jointid.report.drawing.decimation import distinct, outline
from jointid.report.drawing.paths import area_path, bars_path, line_path, points_path, runs
from jointid.report.drawing.scale import Places, Scale, drawable

UNIT = 10  # places per unit of the picture; a unit is about a pixel
_DENSE = 4  # samples per column above which only a line's outline is drawn
_MANY = 3000  # number of points above which overlapping points are drawn once


def mark_path(mark: Mark, across: Scale, up: Scale) -> Html | None:
    """Return a mark as an element; None if nothing is visible."""
    kind, path = _kind_and_path(mark, across, up)
    return element("path", class_=f"{kind} {mark.look}", d=path) if path else None


def legend_sample(mark: Mark, across: int, up: int) -> Html:
    """Return the legend's sample of a mark at a place."""
    kind = mark_kind(mark)
    paths = {
        "points": f"M{across + 20} {up}h0M{across + 90} {up}h0M{across + 160} {up}h0",
        "band": f"M{across} {up - 50}h180v100h-180z",
        "bars": f"M{across} {up - 50}h180v100h-180z",
        "shade": f"M{across} {up - 50}h180v100h-180z",
    }
    path = paths.get(kind, f"M{across} {up}h180")
    return element("path", class_=f"{kind} {mark.look}", d=path)


def mark_kind(mark: Mark) -> str:
    """Return the mark's class in the style sheet."""
    if isinstance(mark, Level) or (isinstance(mark, Line) and mark.dashed):
        return "dashed"
    if isinstance(mark, Line) and mark.series:
        return "line series"
    kinds = {Points: "points", Band: "band", Bars: "bars", Shade: "shade", Range: "shade"}
    return kinds.get(type(mark), "line")


def _kind_and_path(mark: Mark, across: Scale, up: Scale) -> tuple[str, str]:
    kind = mark_kind(mark)
    if isinstance(mark, Level):
        if not drawable(numbers([mark.up]), up.logarithmic)[0]:
            return kind, ""
        return kind, f"M{across.start} {int(up.places(mark.up))}H{across.stop}"
    if isinstance(mark, Band):
        return kind, _band(mark, across, up)
    if isinstance(mark, Shade):
        return kind, _shades(mark, across, up)
    if isinstance(mark, Range):
        ends = numbers([mark.low, mark.high])
        if not drawable(ends, up.logarithmic).all():
            return kind, ""
        low, high = up.places(ends).tolist()
        return kind, f"M{across.start} {low}V{high}H{across.stop}V{low}z"
    if isinstance(mark, Bars):
        edges, values = across.places(mark.edges), numbers(mark.up)
        shown = drawable(values)
        tops = up.places(values[shown])
        return kind, bars_path(edges[:-1][shown], edges[1:][shown], tops, int(up.places(0.0)))
    assert isinstance(mark, Line | Points)
    x, y = numbers(mark.across), numbers(mark.up)
    shown = drawable(x, across.logarithmic) & drawable(y, up.logarithmic)
    if isinstance(mark, Line):
        return kind, _line(x, y, shown, across, up)
    places, heights = across.places(x[shown]), up.places(y[shown])
    if len(places) > _MANY:
        seen = distinct(places, heights, UNIT)
        places, heights = places[seen], heights[seen]
    return kind, points_path(places, heights)


def _line(
    x: NDArray[np.float64],
    y: NDArray[np.float64],
    shown: NDArray[np.bool_],
    across: Scale,
    up: Scale,
) -> str:
    paths = []
    for run in runs(shown):
        places, values = across.places(x[run]), y[run]
        if _is_dense(places, across):
            kept = outline(places // UNIT, values)
            places, values = places[kept], values[kept]
        paths.append(line_path(places, up.places(values)))
    return "".join(paths)


def _band(mark: Band, across: Scale, up: Scale) -> str:
    x, low, high = numbers(mark.across), numbers(mark.low), numbers(mark.high)
    shown = drawable(x, across.logarithmic)
    shown &= drawable(low, up.logarithmic) & drawable(high, up.logarithmic)
    paths = []
    for run in runs(shown):
        places, under, over = across.places(x[run]), low[run], high[run]
        if _is_dense(places, across):
            columns = places // UNIT
            kept = np.union1d(outline(columns, under), outline(columns, over))
            places, under, over = places[kept], under[kept], over[kept]
        paths.append(area_path(places, up.places(under), up.places(over)))
    return "".join(paths)


def _shades(mark: Shade, across: Scale, up: Scale) -> str:
    start, stop = across.places(mark.start), across.places(mark.stop)
    # Each is at least a pixel wide. Adjacent ones are merged.
    stop = np.maximum(stop, start + UNIT)
    apart = np.flatnonzero(start[1:] > np.maximum.accumulate(stop)[:-1] + UNIT) + 1
    if len(start) == 0:
        return ""
    left = start[np.concatenate([[0], apart])]
    right = np.maximum.accumulate(stop)[np.concatenate([apart - 1, [len(stop) - 1]])]
    top = np.full(len(left), up.stop, dtype=np.int64)
    return bars_path(left, np.minimum(right, across.stop), top, up.start)


def _is_dense(places: Places, across: Scale) -> bool:
    """Return whether there are more samples than the picture can show, in the order of the axis."""
    columns = (across.stop - across.start) // UNIT
    return len(places) > _DENSE * columns and bool((np.diff(places) >= 0).all())
