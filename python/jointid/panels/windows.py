"""Pictures of measured and fitted windows over time, and of residuals over velocity."""

from __future__ import annotations

from typing import TYPE_CHECKING

from jointid.estimate.window_views import (
    fitted_signal,
    whole_windows,
    window_centres,
    with_gaps,
)
from jointid.joint.units import velocity_label
from jointid.panels.marks import Level, Line, Panel, Picture, Points

if TYPE_CHECKING:
    from jointid.estimate.estimate import Estimate


def window_means(estimate: Estimate) -> Picture:
    """Return measured and fitted mean of each window over time, above the residual."""
    windows = estimate.windows
    centre = window_centres(windows)
    signal, unit = fitted_signal(estimate)
    time, fitted = with_gaps(centre, windows.fitted / windows.duration)
    means = Panel(
        across="time [s]",
        up=f"{signal}, window mean [{unit}]",
        marks=(
            Points(
                look="measured",
                label="measured",
                across=centre,
                up=windows.measured / windows.duration,
            ),
            Line(label="fitted", across=time, up=fitted),
        ),
    )
    residuals = Panel(
        across="time [s]",
        up=f"residual [{unit}]",
        height=110,
        marks=(
            Points(look="second", across=centre, up=windows.residual / windows.duration),
            Level(look="measured", up=0.0),
        ),
    )
    return Picture(
        caption="Above: measured and fitted mean of each window. Below: residual. Windows at standstill are left out.",
        panels=(means, residuals),
    )


def residuals_over_velocity(estimate: Estimate) -> Picture:
    """Return the residual over velocity. It shows a form of friction that the model lacks."""
    windows = estimate.windows
    whole = whole_windows(windows)
    panel = Panel(
        across=velocity_label(estimate.settings["kind"]),
        up=f"residual [{fitted_signal(estimate)[1]}]",
        height=110,
        marks=(
            Points(
                look="second",
                across=windows.velocity[whole],
                up=(windows.residual / windows.duration)[whole],
            ),
            Level(look="measured", up=0.0),
        ),
    )
    return Picture(
        caption="Residual over velocity. If the residual follows a curve, friction has another form.",
        panels=(panel,),
    )
