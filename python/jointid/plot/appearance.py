"""The style of all plots. Curves differ in colour, dash and marker, for print and for colour-blind readers."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, cast

from jointid.base.errors import InputError
from jointid.panels.palette import DASHES, LIGHT, LOOKS

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_MARKERS = ("o", "s", "^", "D", "v", "P")
_STYLE: dict[str, Any] = {
    "figure.dpi": 110,
    "figure.constrained_layout.use": True,
    "font.size": 9.0,
    "axes.grid": True,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "grid.alpha": 0.3,
    "legend.frameon": False,
    "lines.linewidth": 1.2,
}


@contextmanager
def style() -> Iterator[None]:
    """Apply the Matplotlib settings of jointid's plots within a `with` block.

    Settings from the user's style sheet or `rcParams` are kept.

    Examples
    --------
    >>> from matplotlib import pyplot
    >>> with jid.plot.style():
    ...     figure, axes = pyplot.subplots()
    """
    from matplotlib import interactive, is_interactive, rc_context

    drawing = is_interactive()
    try:
        with rc_context(cast("Any", _left_to_us())):
            try:
                yield
            finally:
                drawing = is_interactive()
    finally:
        # A notebook's back end is loaded with the first figure, perhaps here, and changes this setting.
        interactive(drawing)


def _left_to_us() -> dict[str, Any]:
    """Return our settings, except those that the user has changed."""
    return {name: ours for name, ours in _STYLE.items() if _chosen(name) is None}


def _chosen(setting: str) -> Any:
    """Return the user's value of a Matplotlib setting; None if it is Matplotlib's default."""
    import matplotlib

    settings: tuple[Any, Any] = (matplotlib.rcParams, matplotlib.rcParamsDefault)
    now, usual = (each[setting] for each in settings)
    return None if now == usual else now


def look(style: Mapping[str, Any], **ours: Any) -> dict[str, Any]:
    """Return the keywords of a curve: the user's keywords, and ours for the rest.

    Short names are recognized: ``lw`` is ``linewidth``.

    Raises
    ------
    InputError
        ``axes`` is one of the keywords. The argument's name is `ax`.
    """
    from matplotlib.cbook import normalize_kwargs
    from matplotlib.lines import Line2D

    if "axes" in style:
        raise InputError("give the axes to draw into as `ax`", argument="axes")
    return {**ours, **normalize_kwargs(dict(style), Line2D)}


def axes_or_new(ax: Axes | None) -> Axes:
    """Return these axes, or new axes in our style for None.

    Raises
    ------
    InputError
        The argument is not Matplotlib axes.
    """
    from matplotlib.axes import Axes

    if ax is not None:
        if not isinstance(ax, Axes):
            raise InputError(
                "Matplotlib axes are expected, for example from pyplot.subplots()",
                argument="ax",
                value=ax,
            )
        return ax
    from matplotlib import pyplot

    with style():
        return pyplot.subplots(figsize=(6.4, 4.0))[1]


def line_style(number: int, count: int = 0) -> dict[str, Any]:
    """Return the keywords of `Axes.plot` for a curve: colour, dash and, with `count`, spaced markers.

    Parameters
    ----------
    number : int
        Number of the curve, starting at 0. Styles repeat after six curves.
    count : int
        Number of samples of the curve. About twelve samples have a marker. Default 0: no markers.

    Returns
    -------
    dict of str to object
    """
    place = number % len(LOOKS)
    dashes = DASHES[LOOKS[place]]
    cycle = _chosen("axes.prop_cycle")
    own = [] if cycle is None else cycle.by_key().get("color", [])
    keywords: dict[str, Any] = {
        "color": own[number % len(own)] if own else LIGHT[LOOKS[place]],
        "linestyle": (0, dashes) if dashes else "-",
        "linewidth": line_width(),
    }
    if count:
        step = max(1, count // 12)
        keywords |= {
            "marker": _MARKERS[place],
            "markersize": 4,
            "markevery": (number * step // len(LOOKS), step),
        }
    return keywords


def line_width() -> float:
    """Return the user's line width, or ours."""
    return float(_chosen("lines.linewidth") or _STYLE["lines.linewidth"])
