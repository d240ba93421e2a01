"""Plots of an estimate: friction map, window means, residuals, convergence of the search."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

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
from jointid.plot.appearance import FITTED, MEASURED, SECOND, axes_or_new, look
from jointid.recording.recording import Recording

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def _draw_curve(axes: Axes, curve: FrictionCurve, style: Mapping[str, Any]) -> None:
    keywords = look(style, color=FITTED)
    for side in (curve.velocity < 0.0, curve.velocity > 0.0):
        axes.fill_between(
            curve.velocity[side],
            curve.lower[side],
            curve.upper[side],
            color=keywords["color"],
            alpha=0.25,
            linewidth=0,
        )
        label = keywords.get("label", "identified, with 95 % band")
        shown = {**keywords, "label": label if curve.velocity[side][0] > 0.0 else None}
        axes.plot(curve.velocity[side], curve.torque[side], **shown)


def friction_map(
    recording: Recording | None, estimate: Estimate, ax: Axes | None = None, **style: Any
) -> Axes:
    """Draw friction over velocity: one point per window, and the identified curve with its 95 % band.

    Parameters
    ----------
    recording : Recording or None
        The recording that the points come from; None: the windows that the estimate was fitted to.
    estimate : Estimate
    ax : Axes, optional
        Drawn into. Default: new axes.
    **style
        Keywords of Matplotlib's `Axes.plot` for the identified curve, e.g. ``color="black"``.

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
    axes = axes_or_new(ax)
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
    _draw_curve(axes, estimate.friction(map_velocities(peak)), style)
    kind = estimate.settings["kind"]
    axes.set_xlabel(velocity_label(kind))
    axes.set_ylabel(f"friction [{torque_unit(kind)}]")
    axes.legend(loc="upper left", frameon=False)
    return axes


def window_means(estimate: Estimate, ax: Axes | None = None, **style: Any) -> Axes:
    """Draw the measured and the fitted mean of each window over time.

    Parameters
    ----------
    estimate : Estimate
    ax : Axes, optional
        Drawn into. Default: new axes.
    **style
        Keywords of Matplotlib's `Axes.plot` for the fitted line, e.g. ``color="black"``.

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
    axes = axes_or_new(ax)
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
        **look(style, color=FITTED, label="fitted"),
    )
    axes.set_xlabel("time [s]")
    axes.set_ylabel(f"{signal}, window mean [{unit}]")
    axes.legend(loc="best", frameon=False)
    return axes


def residuals(estimate: Estimate, ax: Axes | None = None, **style: Any) -> Axes:
    """Draw the residual (measured minus fitted) of each window over time, as a mean.

    Parameters
    ----------
    estimate : Estimate
    ax : Axes, optional
        Drawn into. Default: new axes.
    **style
        Keywords of Matplotlib's `Axes.plot` for the points, e.g. ``color="black"``.

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
    axes = axes_or_new(ax)
    windows = estimate.windows
    _, unit = fitted_signal(estimate)
    axes.axhline(0.0, color="black", linewidth=0.6)
    keywords = look(style, color=SECOND, marker=".", linestyle="none", markersize=3)
    axes.plot(window_centres(windows), windows.residual / windows.duration, **keywords)
    axes.set_xlabel("time [s]")
    axes.set_ylabel(f"residual [{unit}]")
    return axes


def convergence(estimate: Estimate, ax: Axes | None = None, **style: Any) -> Axes:
    """Draw the penalty over generations: best so far, population mean, and the final result.

    Parameters
    ----------
    estimate : Estimate
        Of a genetic search.
    ax : Axes, optional
        Drawn into. Default: new axes.
    **style
        Keywords of Matplotlib's `Axes.plot` for the curves of the penalty, e.g. ``color="black"``.

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
    axes = axes_or_new(ax)
    history = estimate.convergence
    axes.semilogy(
        history.generation, history.mean, **look(style, color=MEASURED, label="population mean")
    )
    axes.semilogy(
        history.generation, history.best, **look(style, color=SECOND, label="best so far")
    )
    polished = (estimate.settings["ga"] or {}).get("polish") and estimate.settings["method"] == "ga"
    last = "result, with polish" if polished else "result, without polish"
    axes.axhline(estimate.penalty, color=FITTED, linestyle="--", label=last)
    axes.set_xlabel("generation")
    unit = fitted_signal(estimate)[1]
    axes.set_ylabel(f"penalty [({unit}·s)²]")
    axes.legend(loc="best", frameon=False)
    return axes
