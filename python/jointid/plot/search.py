"""Plot of the adaptive probabilities of the genetic search."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from jointid._core import GaOptions, Generation
from jointid.base.argument_checks import require_kind
from jointid.panels.marks import Line, Mark, Panel, Points
from jointid.plot.appearance import axes_or_new
from jointid.plot.drawing import draw, of_kind

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def adaptation(
    options: GaOptions,
    generations: Sequence[Generation] = (),
    ax: Axes | None = None,
    **style: Any,
) -> Axes:
    """Draw the crossover and mutation probabilities over the diversity measure (section 3.2.2 of the thesis).

    Parameters
    ----------
    options : GaOptions
        Options of the search. Constant probabilities give horizontal lines.
    generations : sequence of Generation
        Generations of a search with these options. Each generation adds one point to both lines. Default: none.
    ax : Axes, optional
        Axes to draw into. Default: new axes.
    **style
        Keywords of Matplotlib's `Axes.plot` for the lines, e.g. ``color="black"``.

    Returns
    -------
    Axes
        Axes with diversity measure [–] and probability [–], logarithmic.

    Raises
    ------
    InputError
        `options` is not a `GaOptions`.
    """
    require_kind("options", options, GaOptions)
    corner = [0.0, options.diversity_low, options.diversity_high, 1.0]
    marks: list[Mark] = []
    for name, look, other in (("crossover", "fitted", "third"), ("mutation", "second", "fourth")):
        diverse = getattr(options, f"{name}_probability")
        end = getattr(options, f"{name}_probability_alike") if options.adaptive else diverse
        law = [diverse, diverse, end, end]
        label = f"{name} probability"
        marks.append(Line(look=look, label=label, across=corner, up=law, series=True))
        if generations:
            across = [generation.diversity for generation in generations]
            up = [getattr(generation, f"{name}_probability") for generation in generations]
            marks.append(Points(look=other, label=f"{name} in a search", across=across, up=up))
    panel = Panel(
        across="diversity measure (1: all individuals equal) [–]",
        up="probability [–]",
        marks=tuple(marks),
        logarithmic=True,
    )
    axes = draw(axes_or_new(ax), panel, style, of_kind(panel, Line), loc="center left")
    axes.set_ylim(0.01, 1.3)
    return axes
