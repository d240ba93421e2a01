"""The pictures of an estimate: friction map, windows and residuals, convergence of the search."""

from __future__ import annotations

import numpy as np

from jointid.base.html import Html, element
from jointid.estimate.estimate import Estimate
from jointid.estimate.window_views import (
    fitted_signal,
    map_velocities,
    whole_windows,
    window_centres,
    with_gaps,
)
from jointid.joint.units import torque_unit, velocity_label
from jointid.report.drawing.marks import Band, Level, Line, Mark, Panel, Points
from jointid.report.figure import captioned

_SPEEDS = 150  # of the curve in each direction: at most 5 units of the picture apart


def picture_sections(estimate: Estimate) -> list[Html]:
    """The pictures with their headings, which findings link to."""
    return [
        element("h2", "Friction map", id="friction-map"),
        friction_picture(estimate),
        element("h2", "Windows", id="windows"),
        windows_picture(estimate),
        _residual_picture(estimate),
    ]


def convergence_section(estimate: Estimate) -> list[Html]:
    """The picture of the search with its heading; nothing where the search has none."""
    if estimate.convergence is None:
        return []
    return [element("h2", "Convergence", id="convergence"), _convergence_picture(estimate)]


def friction_picture(estimate: Estimate) -> Html:
    """The friction map, with what it shows."""
    windows = estimate.windows
    whole = whole_windows(windows)
    curve = estimate.friction(map_velocities(float(np.abs(windows.velocity).max()), _SPEEDS))
    rest = len(curve.velocity) // 2  # friction takes any value there: two curves
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
    return captioned(
        "Friction map: a grey point is the friction that the recording shows over one window, the line is the "
        "identified model with its 95 % band.",
        panel,
    )


def windows_picture(estimate: Estimate) -> Html:
    """Measured and fitted windows above their residuals."""
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
    return captioned(
        "Above: measured and fitted mean over each window. Below: the residual. Windows "
        "in which the joint stands still are left out.",
        means,
        residuals,
    )


def _residual_picture(estimate: Estimate) -> Html:
    """What is left over velocity: a form of friction that the model lacks shows there."""
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
    return captioned(
        "The residual over velocity: where it follows a curve, friction has another form.", panel
    )


def _convergence_picture(estimate: Estimate) -> Html:
    history = estimate.convergence
    assert history is not None
    polished = (estimate.settings["ga"] or {}).get("polish") and estimate.settings["method"] == "ga"
    marks: tuple[Mark, ...] = (
        Line(look="measured", label="population mean", across=history.generation, up=history.mean),
        Line(look="second", label="best so far", across=history.generation, up=history.best),
        Level(
            label="result, with polish" if polished else "result, without polish",
            up=estimate.penalty,
        ),
    )
    unit = fitted_signal(estimate)[1]
    panel = Panel(
        across="generation", up=f"penalty [({unit}·s)²]", logarithmic=True, height=130, marks=marks
    )
    return captioned(
        "The genetic search, generation by generation; dashed: the penalty after the local polish.",
        panel,
    )
