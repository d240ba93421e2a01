"""The friction map of an estimate: measured windows and identified curve."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from jointid.estimate.window_views import map_velocities, whole_windows
from jointid.joint.units import torque_unit, velocity_label
from jointid.panels.marks import Band, Line, Panel, Picture, Points

if TYPE_CHECKING:
    from jointid.estimate.estimate import Estimate
    from jointid.problem.window_table import WindowTable

_SPEEDS = 150  # points of the curve in each direction: at most 5 picture units apart


def friction_map(estimate: Estimate, windows: WindowTable | None = None) -> Picture:
    """Return friction over velocity: a point for each window, and the identified curve with its 95 % band.

    Parameters
    ----------
    estimate : Estimate
    windows : WindowTable, optional
        Windows of another recording. Default: those that the estimate was fitted to.
    """
    windows = estimate.windows if windows is None else windows
    whole = whole_windows(windows)
    curve = estimate.friction(map_velocities(float(np.abs(windows.velocity).max()), _SPEEDS))
    rest = len(curve.velocity) // 2  # friction can have any value at rest, so there are two curves
    gap = np.nan
    velocity, torque, lower, upper = (
        np.concatenate([values[:rest], [gap], values[rest:]])
        for values in (curve.velocity, curve.torque, curve.lower, curve.upper)
    )
    kind = estimate.settings["kind"]
    panel = Panel(
        across=velocity_label(kind),
        up=f"friction [{torque_unit(kind)}]",
        height=260,
        marks=(
            Points(
                look="measured",
                label="measured, window mean",
                across=windows.velocity[whole],
                up=windows.friction[whole],
            ),
            Band(across=velocity, low=lower, high=upper),
            Line(label="identified, with 95 % band", across=velocity, up=torque),
        ),
    )
    return Picture(
        caption="Friction map. Grey points: measured friction of each window. Line: identified model with its 95 % "
        "band.",
        panels=(panel,),
    )
