"""Plot of the adaptive probabilities of the genetic search."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from jointid._core import GaOptions, Generation
from jointid.base.argument_checks import require_kind
from jointid.plot.appearance import axes_or_new, line_style, look

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def adaptation(
    options: GaOptions,
    generations: Sequence[Generation] = (),
    ax: Axes | None = None,
    **style: Any,
) -> Axes:
    """Draw the crossover and mutation probabilities over the diversity measure (3.2.2).

    Parameters
    ----------
    options : GaOptions
        If they are not adaptive, both lines are constant.
    generations : sequence of Generation
        Of a search with these options; each adds one point to both lines. Default: none.
    ax : Axes, optional
        Drawn into. Default: new axes.
    **style
        Keywords of Matplotlib's `Axes.plot` for the lines, e.g. ``color="black"``.

    Returns
    -------
    Axes
        Diversity measure [–], probability [–], logarithmic.

    Raises
    ------
    InputError
        `options` is not a `GaOptions`.
    """
    require_kind("options", options, GaOptions)
    axes = axes_or_new(ax)
    corner = [0.0, options.diversity_low, options.diversity_high, 1.0]
    for number, (name, diverse, equal) in enumerate(
        (
            ("crossover", options.crossover_probability, options.crossover_probability_alike),
            ("mutation", options.mutation_probability, options.mutation_probability_alike),
        )
    ):
        end = equal if options.adaptive else diverse
        keywords = look(style, **line_style(number), label=f"{name} probability")
        axes.plot(corner, [diverse, diverse, end, end], **keywords)
        if generations:
            axes.plot(
                [generation.diversity for generation in generations],
                [getattr(generation, f"{name}_probability") for generation in generations],
                "os"[number],
                color=keywords["color"],
                markersize=4,
                markerfacecolor="none",
                label=f"{name} in a search",
            )
    axes.set_xlabel("diversity measure (1: all individuals equal) [–]")
    axes.set_ylabel("probability [–]")
    axes.set_yscale("log")
    axes.set_ylim(0.01, 1.3)
    axes.legend(loc="center left", frameon=False)
    return axes
