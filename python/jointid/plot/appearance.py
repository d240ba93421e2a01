"""One style for all plots: curves differ in colour, dash and marker, also in print and for the colour-blind."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, cast

if TYPE_CHECKING:
    from matplotlib.axes import Axes

# Okabe and Ito's palette: distinct for the colour-blind, and in grey print by lightness.
MEASURED = "#999999"
FITTED = "#D55E00"
SECOND = "#0072B2"
_LINES: tuple[tuple[str, Any, str], ...] = (
    ("#000000", "-", "o"),
    (FITTED, (0, (6, 2)), "s"),
    (SECOND, (0, (6, 2, 1, 2)), "^"),
    ("#009E73", (0, (2, 1)), "D"),
    ("#CC79A7", (0, (8, 2, 1, 1, 1, 1, 1, 2)), "v"),
    ("#E69F00", (0, (4, 1)), "P"),
)
_STYLE: dict[str, Any] = {
    "figure.dpi": 110,
    "figure.constrained_layout.use": True,
    "font.size": 9.0,
    "axes.grid": True,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "grid.alpha": 0.3,
    "legend.frameon": False,
    "lines.linewidth": 1.5,
}


@contextmanager
def style() -> Iterator[None]:
    """Apply the Matplotlib settings of all our plots within a `with` block.

    Examples
    --------
    >>> with jid.plot.style():
    ...     figure, axes = pyplot.subplots()
    """
    from matplotlib import interactive, is_interactive, rc_context

    drawing = is_interactive()
    try:
        with rc_context(cast("Any", _STYLE)):
            try:
                yield
            finally:
                drawing = is_interactive()
    finally:
        # A notebook's back end is loaded with the first figure, perhaps here, and turns this on.
        interactive(drawing)


def axes_or_new(axes: Axes | None) -> Axes:
    """Return these axes, or new ones in our style for None."""
    if axes is not None:
        return axes
    from matplotlib import pyplot

    with style():
        return pyplot.subplots(figsize=(6.4, 4.0))[1]


def line_style(number: int, count: int = 0) -> dict[str, Any]:
    """Return the keywords of `Axes.plot` for a curve: colour and dash, and with `count` spaced markers.

    Parameters
    ----------
    number : int
        Of the curve, from 0; styles repeat after six.
    count : int
        Samples of the curve; markers are set at about twelve of them. Default 0: no markers.

    Returns
    -------
    dict of str to object
    """
    colour, dash, marker = _LINES[number % len(_LINES)]
    keywords: dict[str, Any] = {"color": colour, "linestyle": dash, "linewidth": 1.2}
    if count:
        step = max(1, count // 12)
        keywords |= {
            "marker": marker,
            "markersize": 4,
            "markevery": (number * step // len(_LINES), step),
        }
    return keywords
