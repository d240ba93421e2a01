"""Picture of a servo's run: logged, and simulated in closed loop."""

from __future__ import annotations

from typing import TYPE_CHECKING

from jointid.panels.marks import Line, Panel, Picture

if TYPE_CHECKING:
    from jointid.estimate.rollout import RunRollout


def rolled_out(run: RunRollout) -> Picture:
    """Return logged and simulated position of a run over time, with the mean error in the legend."""
    time = run.time - run.time[0]
    label = f"simulated, {run.shown(run.error):.2f} {run.unit} mean error"
    if run.bistable:
        label += ", bistable"
    panel = Panel(
        across="time [s]",
        up=f"position [{run.unit}]",
        marks=(
            Line(label="logged", across=time, up=run.shown(run.measured), look="measured"),
            # dashed, because a good model covers the log
            Line(label=label, across=time, up=run.shown(run.position), dashed=True),
        ),
    )
    return Picture(
        caption="Logged position (grey) and simulated position.", panels=(panel,), title=run.name
    )
