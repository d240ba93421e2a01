"""Windows in pictures: their times, interruptions of lines, and the velocities of curves."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from jointid.estimate.record import EstimateRecord
from jointid.joint.units import torque_unit
from jointid.problem.window_table import WindowTable
from jointid.recording.order_statistics import distinct, median

Array = NDArray[np.float64]


def fitted_signal(estimate: EstimateRecord) -> tuple[str, str]:
    """Return the quantity that the model is fitted to, and its unit."""
    if estimate.settings["residual"] != "torque":
        return "sensor reading", "sensor units"
    kind = estimate.settings["kind"]
    return "force" if kind == "prismatic" else "torque", torque_unit(kind)


def map_velocities(peak: float, count: int = 400) -> Array:
    """Return `count` velocities in each direction up to the peak, dense near rest, where friction is nonlinear."""
    half = peak * np.linspace(0.0, 1.0, count) ** 3
    half[0] = 1e-9 * peak
    return np.concatenate([-half[::-1], half])


def whole_windows(windows: WindowTable) -> NDArray[np.bool_]:
    """Return a mask of windows with enough samples for a mean: more than half of the usual time."""
    return windows.duration > 0.5 * median(windows.duration)


def window_centres(windows: WindowTable) -> Array:
    """Return the window centres on one time axis [s], with the recordings one after the other."""
    centre = 0.5 * (windows.start + windows.stop)
    begin = 0.0
    for run in distinct(windows.recording):
        same = windows.recording == run
        first, last = float(windows.start[same].min()), float(windows.stop[same].max())
        if begin:
            centre[same] += begin - first
        begin += last - first if begin else last
    return np.asarray(centre)


def with_gaps(centre: Array, *values: Array) -> tuple[Array, ...]:
    """Return centres and values with NaN for missing windows, because nothing was measured there."""
    if len(centre) < 3:
        return (centre, *values)
    steps = np.diff(centre)
    breaks = np.flatnonzero(steps > 2.5 * median(steps)) + 1
    return tuple(np.insert(each, breaks, np.nan) for each in (centre, *values))
