"""Plots of an estimate: friction map, window means, residuals, convergence of the search."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from jointid.base.argument_checks import require_kind
from jointid.base.errors import InputError
from jointid.estimate.estimate import Estimate
from jointid.estimate.statistics import FrictionCurve
from jointid.estimate.window_views import (
    fitted_signal,
    map_velocities,
    whole_windows,
    window_centres,
    with_gaps,
)
from jointid.joint.units import torque_unit, velocity_label
from jointid.plot.appearance import FITTED, MEASURED, SECOND, axes_or_new
from jointid.recording.recording import Recording

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def _draw_curve(axes: Axes, curve: FrictionCurve) -> None:
    for side in (curve.velocity < 0.0, curve.velocity > 0.0):
        axes.fill_between(
            curve.velocity[side],
            curve.lower[side],
            curve.upper[side],
            color=FITTED,
            alpha=0.25,
            linewidth=0,
        )
        label = "identified, with 95 % band" if curve.velocity[side][0] > 0.0 else None
        axes.plot(curve.velocity[side], curve.torque[side], color=FITTED, label=label)


def friction_map(recording: Recording | None, estimate: Estimate, axes: Axes | None = None) -> Axes:
    """Draw friction over velocity: one point per window, and the identified curve with its 95 % band.

    Parameters
    ----------
    recording : Recording or None
        The recording that the points come from; None: the windows that the estimate was fitted to.
    estimate : Estimate
    axes : Axes, optional
        Drawn into. Default: new axes.

    Returns
    -------
    Axes
        Velocity [rad/s] or [m/s], friction [N·m] or [N].

    Raises
    ------
    InputError
        An argument of another kind, or a recording that the estimate cannot predict.

    Examples
    --------
    >>> jid.plot.friction_map(recording, estimate).figure.savefig("friction.png")
    """
    if recording is not None:
        require_kind("recording", recording, Recording)
    require_kind("estimate", estimate, Estimate)
    axes = axes_or_new(axes)
    windows = estimate.windows if recording is None else estimate.predict(recording).windows
    whole = whole_windows(windows)
    axes.plot(
        windows.velocity[whole],
        windows.friction[whole],
        ".",
        color=MEASURED,
        markersize=3,
        label="measured, window mean",
        rasterized=True,
    )
    peak = float(np.abs(windows.velocity).max())
    _draw_curve(axes, estimate.friction(map_velocities(peak)))
    kind = estimate.settings["kind"]
    axes.set_xlabel(velocity_label(kind))
    axes.set_ylabel(f"friction [{torque_unit(kind)}]")
    axes.legend(loc="upper left", frameon=False)
    return axes


def window_means(estimate: Estimate, axes: Axes | None = None) -> Axes:
    """Draw the measured and the fitted mean of each window over time.

    Parameters
    ----------
    estimate : Estimate
    axes : Axes, optional
        Drawn into. Default: new axes.

    Returns
    -------
    Axes
        Time [s]; the sensor's reading, or torque [N·m] or force [N].

    Raises
    ------
    InputError
        Not an estimate.
    """
    require_kind("estimate", estimate, Estimate)
    axes = axes_or_new(axes)
    windows = estimate.windows
    signal, unit = fitted_signal(estimate)
    centre = window_centres(windows)
    axes.plot(
        centre,
        windows.measured / windows.duration,
        ".",
        color=MEASURED,
        markersize=4,
        label="measured",
    )
    axes.plot(
        *with_gaps(centre, windows.fitted / windows.duration),
        color=FITTED,
        linewidth=1.0,
        label="fitted",
    )
    axes.set_xlabel("time [s]")
    axes.set_ylabel(f"{signal}, window mean [{unit}]")
    axes.legend(loc="best", frameon=False)
    return axes


def residuals(estimate: Estimate, axes: Axes | None = None) -> Axes:
    """Draw the residual (measured minus fitted) of each window over time, as a mean.

    Parameters
    ----------
    estimate : Estimate
    axes : Axes, optional
        Drawn into. Default: new axes.

    Returns
    -------
    Axes
        Time [s]; the sensor's reading, or torque [N·m] or force [N].

    Raises
    ------
    InputError
        Not an estimate.
    """
    require_kind("estimate", estimate, Estimate)
    axes = axes_or_new(axes)
    windows = estimate.windows
    _, unit = fitted_signal(estimate)
    axes.axhline(0.0, color="black", linewidth=0.6)
    axes.plot(
        window_centres(windows),
        windows.residual / windows.duration,
        ".",
        color=SECOND,
        markersize=3,
    )
    axes.set_xlabel("time [s]")
    axes.set_ylabel(f"residual [{unit}]")
    return axes


def convergence(estimate: Estimate, axes: Axes | None = None) -> Axes:
    """Draw the penalty over generations: best so far, population mean, and the final result.

    Parameters
    ----------
    estimate : Estimate
        Of a genetic search.
    axes : Axes, optional
        Drawn into. Default: new axes.

    Returns
    -------
    Axes
        Generation; penalty [(N·m·s)²], [(N·s)²] or [(sensor units·s)²], logarithmic.

    Raises
    ------
    InputError
        The estimate was made without a genetic search, so there is no convergence to draw.
    """
    require_kind("estimate", estimate, Estimate)
    if estimate.convergence is None:
        raise InputError(
            "it was made without a genetic search, so there is no convergence to draw",
            argument="estimate",
        )
    axes = axes_or_new(axes)
    history = estimate.convergence
    axes.semilogy(history.generation, history.mean, color=MEASURED, label="population mean")
    axes.semilogy(history.generation, history.best, color=SECOND, label="best so far")
    polished = (estimate.settings["ga"] or {}).get("polish") and estimate.settings["method"] == "ga"
    last = "result, with polish" if polished else "result, without polish"
    axes.axhline(estimate.penalty, color=FITTED, linestyle="--", label=last)
    axes.set_xlabel("generation")
    unit = fitted_signal(estimate)[1]
    axes.set_ylabel(f"penalty [({unit}·s)²]")
    axes.legend(loc="best", frameon=False)
    return axes
