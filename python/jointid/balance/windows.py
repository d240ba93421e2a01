"""Windows of a recording, and integrals of sampled signals over intervals and windows.

The core has windows for joints; `_core.window_integrals` is the same rule for signals that are linear between samples.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Windows:
    """Equal windows over the gap-free stretches of a recording."""

    # (windows + 1,), first interval of each window; a window's gap has no usable intervals
    edges: NDArray[np.int64]
    duration: float  # usual length [s]

    @classmethod
    def of(cls, time: Array, duration: float) -> Windows:
        """Return windows of approximately this duration [s]."""
        count = max(1, round(float(time[-1] - time[0]) / duration))
        instants = np.linspace(time[0], time[-1], count + 1)
        edges = np.unique(np.searchsorted(time, instants[:-1], side="left"))
        edges = edges[edges < time.size - 1]
        return cls(edges=np.append(edges, time.size - 1), duration=duration)

    def summed(self, intervals: Array) -> Array:
        """Return sums over the windows, along the last axis."""
        return np.add.reduceat(intervals, self.edges[:-1], axis=-1)


def torque_integrals(torque: Array, step: Array, held: bool) -> Array:
    """Return integrals over the intervals of a torque that is held from its sample on, or linear between samples."""
    if held:
        return np.asarray(step * torque[..., :-1])
    return np.asarray(0.5 * step * (torque[..., 1:] + torque[..., :-1]))


def direction_integrals(velocity: Array, step: Array) -> Array:
    """Return integrals of the velocity's sign over the intervals; reversals are at the velocity's interpolated zero."""
    before, after = velocity[..., :-1], velocity[..., 1:]
    speed = np.abs(before) + np.abs(after)
    share = (before + after) / np.where(speed > 0.0, speed, 1.0)
    return np.where(before * after < 0.0, share, 0.5 * (np.sign(before) + np.sign(after))) * step


def interval_means(signal: Array, velocity: Array) -> Array:
    """Return means over the intervals; in a reversal weighted by the time on each side, as in `direction_integrals`."""
    speed = np.abs(velocity)
    before, after = signal[:-1], signal[1:]
    total = speed[:-1] + speed[1:]
    share = speed[:-1] / np.where(total > 0.0, total, 1.0)
    turned = before * after < 0.0
    return np.where(turned, share * before + (1.0 - share) * after, 0.5 * (before + after))
