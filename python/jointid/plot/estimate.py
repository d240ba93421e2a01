"""Plots of an estimate: friction map, window means, residuals, convergence of the search."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from jointid.base.argument_checks import require_kind
from jointid.base.errors import InputError
from jointid.estimate.estimate import Estimate
from jointid.estimate.statistics import FrictionCurve
from jointid.plot.appearance import FITTED, MEASURED, SECOND, axes_or_new, look
from jointid.plot.units import torque_unit, velocity_label
from jointid.recording.recording import Recording

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def _measured(estimate: Estimate) -> tuple[str, str]:
    """Return the quantity that the model is fitted to, and its unit."""
    if estimate.settings["residual"] != "torque":
        return "sensor reading", "sensor units"
    kind = estimate.settings["kind"]
    return "force" if kind == "prismatic" else "torque", torque_unit(kind)


def _speeds(peak: float) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
    """Return velocities up to the peak in both directions, dense near rest, where friction is nonlinear."""
    half = peak * np.linspace(0.0, 1.0, 400) ** 3
    half[0] = 1e-9 * peak
    return np.concatenate([-half[::-1], half])


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
    whole = windows.duration > 0.5 * float(np.median(windows.duration))
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
    _draw_curve(axes, estimate.friction(_speeds(peak)), style)
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
    signal, unit = _measured(estimate)
    centre = _centres(estimate)
    axes.plot(
        centre,
        windows.measured / windows.duration,
        ".",
        color=MEASURED,
        markersize=4,
        label="measured",
    )
    axes.plot(
        *_with_gaps(estimate, windows.fitted / windows.duration),
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
    _, unit = _measured(estimate)
    axes.axhline(0.0, color="black", linewidth=0.6)
    keywords = look(style, color=SECOND, marker=".", linestyle="none", markersize=3)
    axes.plot(_centres(estimate), windows.residual / windows.duration, **keywords)
    axes.set_xlabel("time [s]")
    axes.set_ylabel(f"residual [{unit}]")
    return axes


def _centres(estimate: Estimate) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
    """Return the window centres on one time axis, on which recordings follow one another."""
    windows = estimate.windows
    centre = 0.5 * (windows.start + windows.stop)
    begin = 0.0
    for run in np.unique(windows.recording):
        same = windows.recording == run
        first, last = float(windows.start[same].min()), float(windows.stop[same].max())
        if begin:
            centre[same] += begin - first
        begin += last - first if begin else last
    return np.asarray(centre)


def _with_gaps(
    estimate: Estimate, values: np.ndarray[tuple[int], np.dtype[np.float64]]
) -> tuple[
    np.ndarray[tuple[int], np.dtype[np.float64]], np.ndarray[tuple[int], np.dtype[np.float64]]
]:
    """Return a line that is interrupted where windows are missing: nothing was measured there."""
    centre = _centres(estimate)
    breaks = np.flatnonzero(np.diff(centre) > 2.5 * float(np.median(np.diff(centre)))) + 1
    return np.insert(centre, breaks, np.nan), np.insert(values, breaks, np.nan)


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
    unit = _measured(estimate)[1]
    axes.set_ylabel(f"penalty [({unit}·s)²]")
    axes.legend(loc="best", frameon=False)
    return axes
