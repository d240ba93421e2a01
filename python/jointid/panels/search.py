"""Picture of an estimate's genetic search over its generations."""

from __future__ import annotations

from typing import TYPE_CHECKING

from jointid.estimate.window_views import fitted_signal
from jointid.panels.marks import Level, Line, Panel, Picture

if TYPE_CHECKING:
    from jointid.estimate.estimate import Estimate


def convergence(estimate: Estimate) -> Picture:
    """Return the penalty over generations, for an estimate with `convergence`: best, mean, and the result."""
    history = estimate.convergence
    assert history is not None
    polished = (estimate.settings["ga"] or {}).get("polish") and estimate.settings["method"] == "ga"
    panel = Panel(
        across="generation",
        up=f"penalty [({fitted_signal(estimate)[1]}·s)²]",
        logarithmic=True,
        height=130,
        marks=(
            Line(
                look="measured", label="population mean", across=history.generation, up=history.mean
            ),
            Line(look="second", label="best so far", across=history.generation, up=history.best),
            Level(
                label="result, with polish" if polished else "result, without polish",
                up=estimate.penalty,
            ),
        ),
    )
    return Picture(
        caption="Penalty in each generation of the genetic search; dashed: the penalty after the local polish.",
        panels=(panel,),
    )
