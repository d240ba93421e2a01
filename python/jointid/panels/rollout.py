"""A servo's run as logged, and as its closed loop is simulated."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from jointid.panels.marks import Line, Panel, Picture

if TYPE_CHECKING:
    from jointid.servo.rolling_out import RunRollout


def rolled_out(run: RunRollout) -> Picture:
    """Position of a run over time, as logged and as simulated, with the mean error in the legend."""
    time = run.time - run.time[0]
    label = f"simulated, {np.degrees(run.error):.2f}° mean error"
    if run.bistable:
        label += ", bistable"
    panel = Panel(
        across="time [s]",
        up="position [deg]",
        marks=(
            Line(label="logged", across=time, up=np.degrees(run.measured), look="measured"),
            # Dashed, since a good model lies upon the log.
            Line(label=label, across=time, up=np.degrees(run.position), dashed=True),
        ),
    )
    return Picture(
        caption="Position as logged (grey) and as simulated.", panels=(panel,), title=run.name
    )
