"""Pictures of the search's own settings."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from jointid._core import GaOptions, Generation
from jointid.plot.appearance import given_or_new, line_style

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def adaptation(
    options: GaOptions, generations: Sequence[Generation] = (), axes: Axes | None = None
) -> Axes:
    """Crossover and mutation probability over the diversity measure (3.2.2).

    Parameters
    ----------
    options : GaOptions
        Adaptive ones; of others both lines are level.
    generations : sequence of Generation
        Of a search with these options: a point each, to be seen on the lines.
    axes : Axes, optional
        Drawn into; default: new ones.
    """
    axes = given_or_new(axes)
    corner = [0.0, options.diversity_low, options.diversity_high, 1.0]
    for number, (name, apart, alike) in enumerate(
        (
            ("crossover", options.crossover_probability, options.crossover_probability_alike),
            ("mutation", options.mutation_probability, options.mutation_probability_alike),
        )
    ):
        end = alike if options.adaptive else apart
        keywords = line_style(number)
        axes.plot(corner, [apart, apart, end, end], label=f"{name} probability", **keywords)
        if generations:
            axes.plot(
                [generation.diversity for generation in generations],
                [getattr(generation, f"{name}_probability") for generation in generations],
                "os"[number],
                color=keywords["color"],
                markersize=4,
                markerfacecolor="none",
                label=f"{name}, generations of a search",
            )
    axes.set_xlabel("diversity measure, 1 where all are alike [–]")
    axes.set_ylabel("probability [–]")
    axes.set_yscale("log")
    axes.set_ylim(0.01, 1.3)
    axes.legend(loc="center left", frameon=False)
    return axes
