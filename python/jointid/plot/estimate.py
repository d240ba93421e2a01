"""Pictures of recordings and estimates: one style, units on the axes, Matplotlib axes in and out."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from jointid.base.argument_checks import require_kind
from jointid.estimate.estimate import Estimate
from jointid.estimate.statistics import FrictionCurve
from jointid.plot.appearance import FITTED, MEASURED, SECOND
from jointid.plot.appearance import given_or_new as _axes
from jointid.recording.recording import Recording

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def _torque_unit(estimate: Estimate) -> str:
    return "N" if estimate.settings["kind"] == "prismatic" else "N·m"


def _compared(estimate: Estimate) -> tuple[str, str]:
    """What the residual is compared with, and its unit."""
    if estimate.settings["residual"] == "sensor":
        return "sensor reading", "sensor units"
    prismatic = estimate.settings["kind"] == "prismatic"
    return ("force", "N") if prismatic else ("torque", "N·m")


def _speeds(peak: float) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
    """Speeds from rest to the peak, dense near rest where friction bends."""
    half = peak * np.linspace(0.0, 1.0, 400) ** 3
    half[0] = 1e-9 * peak
    return np.concatenate([-half[::-1], half])


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
    """Friction over velocity: a point a window, and the identified curve with its band.

    Parameters
    ----------
    recording : Recording or None
        Points come from this recording; None: from the windows the estimate was made of.
    estimate : Estimate
    axes : Axes, optional
        Drawn into; default: new ones.
    """
    if recording is not None:
        require_kind("recording", recording, Recording)
    require_kind("estimate", estimate, Estimate)
    axes = _axes(axes)
    windows = estimate.windows if recording is None else estimate.predict(recording).windows
    whole = windows.duration > 0.5 * float(np.median(windows.duration))
    axes.plot(
        windows.velocity[whole],
        windows.friction[whole],
        ".",
        color=MEASURED,
        markersize=3,
        label="measured, mean over a window",
        rasterized=True,
    )
    peak = float(np.abs(windows.velocity).max())
    _draw_curve(axes, estimate.friction(_speeds(peak)))
    prismatic = estimate.settings["kind"] == "prismatic"
    axes.set_xlabel("velocity [m/s]" if prismatic else "velocity [rad/s]")
    axes.set_ylabel(f"friction [{_torque_unit(estimate)}]")
    axes.legend(loc="upper left", frameon=False)
    return axes


def window_means(estimate: Estimate, axes: Axes | None = None) -> Axes:
    """What was measured over each window, as a mean, and what the model makes of it."""
    axes = _axes(axes)
    windows = estimate.windows
    signal, unit = _compared(estimate)
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
        *_broken(estimate, windows.fitted / windows.duration),
        color=FITTED,
        linewidth=1.0,
        label="fitted",
    )
    axes.set_xlabel("time [s]")
    axes.set_ylabel(f"{signal}, window mean [{unit}]")
    axes.legend(loc="best", frameon=False)
    return axes


def residuals(estimate: Estimate, axes: Axes | None = None) -> Axes:
    """Measured less fitted, as a mean over each window."""
    axes = _axes(axes)
    windows = estimate.windows
    _, unit = _compared(estimate)
    axes.axhline(0.0, color="black", linewidth=0.6)
    axes.plot(
        _centres(estimate), windows.residual / windows.duration, ".", color=SECOND, markersize=3
    )
    axes.set_xlabel("time [s]")
    axes.set_ylabel(f"residual [{unit}]")
    return axes


def _centres(estimate: Estimate) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
    """Window centres on one time axis; recordings follow one another."""
    windows = estimate.windows
    centre = 0.5 * (windows.start + windows.stop)
    begin = 0.0
    for run in np.unique(windows.recording):
        mine = windows.recording == run
        first, last = float(windows.start[mine].min()), float(windows.stop[mine].max())
        if begin:
            centre[mine] += begin - first
        begin += last - first if begin else last
    return np.asarray(centre)


def _broken(
    estimate: Estimate, values: np.ndarray[tuple[int], np.dtype[np.float64]]
) -> tuple[
    np.ndarray[tuple[int], np.dtype[np.float64]], np.ndarray[tuple[int], np.dtype[np.float64]]
]:
    """A line that is interrupted where windows are missing, so that it does not claim what nobody saw."""
    centre = _centres(estimate)
    breaks = np.flatnonzero(np.diff(centre) > 2.5 * float(np.median(np.diff(centre)))) + 1
    return np.insert(centre, breaks, np.nan), np.insert(values, breaks, np.nan)


def convergence(estimate: Estimate, axes: Axes | None = None) -> Axes:
    """Penalty over generations: best so far, population mean, and the polished end.

    Raises
    ------
    ValueError
        The estimate was made without a genetic search.
    """
    if estimate.convergence is None:
        raise ValueError(
            "the estimate was made without a genetic search: there is no convergence to draw"
        )
    axes = _axes(axes)
    history = estimate.convergence
    axes.semilogy(history.generation, history.mean, color=MEASURED, label="population mean")
    axes.semilogy(history.generation, history.best, color=SECOND, label="best so far")
    polished = (estimate.settings["ga"] or {}).get("polish") and estimate.settings["method"] == "ga"
    last = "after the polish" if polished else "the answer, not polished"
    axes.axhline(estimate.penalty, color=FITTED, linestyle="--", label=last)
    axes.set_xlabel("generation")
    unit = _compared(estimate)[1]
    axes.set_ylabel(f"penalty [({unit}·s)²]")
    axes.legend(loc="best", frameon=False)
    return axes
