"""Draw a panel into Matplotlib axes, with the same marks, labels and legend as in a report."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from jointid.panels.marks import (
    Band,
    Bars,
    Level,
    Line,
    Mark,
    Panel,
    Points,
    Range,
    Shade,
    numbers,
)
from jointid.panels.palette import BAND, LIGHT, LOOKS
from jointid.plot.appearance import line_style, line_width, look, style

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_SIZES = ((300, 5.0), (1000, 3.0))  # number of points, and size
_SMALLEST = 2.0
_MANY = 1000  # number of points above which a vector format stores them as an image


def draw(
    axes: Axes,
    panel: Panel,
    keywords: Mapping[str, Any] | None = None,
    styled: Collection[Mark] = (),
    **legend: Any,
) -> Axes:
    """Draw a panel and return the axes.

    Parameters
    ----------
    axes : Axes
    panel : Panel
    keywords : mapping of str to object, optional
        Keywords of `Axes.plot` for the marks in `styled`, which replace ours.
    styled : collection of Mark
        Lines and points of the panel that get the keywords. A band of the same look takes their colour.
        Default: none.
    **legend
        Keywords of `Axes.legend`. Default: the best place.
    """
    chosen = look(keywords or {})
    recoloured = {mark.look for mark in styled} if "color" in chosen else set()
    for mark in panel.marks:
        colour = chosen["color"] if mark.look in recoloured else LIGHT[mark.look]
        _draw_mark(axes, mark, colour, chosen if mark in styled else {})
    drawn = [axes]
    if panel.right:
        drawn.append(_right_axis(axes, panel))
    axes.set_xlabel(panel.across)
    axes.set_ylabel(panel.up)
    if panel.logarithmic:
        axes.set_yscale("log")
    if panel.logarithmic_across:
        axes.set_xscale("log")
    if panel.names:
        axes.set_yticks([-float(row) for row in range(len(panel.names))], panel.names)
        axes.set_ylim(0.5 - len(panel.names), 0.5)
    handles, labels = zip(*(each.get_legend_handles_labels() for each in drawn), strict=True)
    if any(labels):
        axes.legend(
            [each for some in handles for each in some],
            [each for some in labels for each in some],
            **{"loc": "best", "frameon": False, **legend},
        )
    return axes


def of_kind(panel: Panel, kind: type[Mark]) -> tuple[Mark, ...]:
    """Return the marks of one kind on a panel's first axes."""
    return tuple(mark for mark in panel.marks if isinstance(mark, kind))


def _draw_mark(axes: Axes, mark: Mark, colour: str, chosen: Mapping[str, Any]) -> None:
    label = mark.label or None
    if isinstance(mark, Line):
        across = numbers(mark.across)
        ours: dict[str, Any] = {"color": colour, "linewidth": line_width()}
        if mark.series:
            ours = line_style(LOOKS.index(mark.look), len(across))
        if mark.dashed:
            ours["linestyle"] = "--"
        axes.plot(across, numbers(mark.up), **{**ours, "label": label, **chosen})
    elif isinstance(mark, Points):
        across = numbers(mark.across)
        ours = {"color": colour, "linestyle": "none", "marker": ".", "label": label}
        ours |= {"markersize": _size(len(across)), "rasterized": len(across) > _MANY}
        axes.plot(across, numbers(mark.up), **{**ours, **chosen})
    elif isinstance(mark, Level):
        axes.axhline(mark.up, color=colour, linestyle="--", linewidth=1.0, label=label)
    elif isinstance(mark, Bars):
        from matplotlib.colors import to_rgba

        edges = numbers(mark.edges)
        ours = {"facecolor": to_rgba(colour, BAND), "edgecolor": colour, "linewidth": 0.8}
        heights, widths = numbers(mark.up), np.diff(edges)
        axes.bar(edges[:-1], heights, widths, align="edge", label=label, **ours)
    else:
        _draw_area(axes, mark, {"color": colour, "alpha": BAND, "linewidth": 0.0, "label": label})


def _draw_area(axes: Axes, mark: Mark, keywords: Mapping[str, Any]) -> None:
    if isinstance(mark, Band):
        low, high = numbers(mark.low), numbers(mark.high)
        axes.fill_between(numbers(mark.across), low, high, **keywords)
    elif isinstance(mark, Range):
        axes.axhspan(mark.low, mark.high, **keywords)
    elif isinstance(mark, Shade):
        pairs = zip(numbers(mark.start).tolist(), numbers(mark.stop).tolist(), strict=True)
        for number, (start, stop) in enumerate(pairs):
            label = None if number else keywords["label"]  # one legend entry for all
            axes.axvspan(start, stop, **{**keywords, "label": label})
    else:
        raise NotImplementedError(f"no way to draw {type(mark).__name__}")


def _right_axis(axes: Axes, panel: Panel) -> Axes:
    with style():
        beside = axes.twinx()
    for mark in panel.right:
        _draw_mark(beside, mark, LIGHT[mark.look], {})
    beside.set_ylabel(panel.right_up)
    beside.spines["right"].set_visible(True)
    beside.grid(visible=False)
    return beside


def _size(count: int) -> float:
    return next((size for most, size in _SIZES if count <= most), _SMALLEST)
