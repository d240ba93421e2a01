"""Intervals near a reversal or a standstill, where a velocity derived from few samples is wrong.

Dry friction and acceleration jump there. A smooth velocity has an error of a quarter of the jump times the sample
period, always in the same direction. This error looks like a delay of the torque.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]

_REACH = 2  # intervals on both sides


def away_from_reversals(moving: Flags, velocity: Array) -> Flags:
    """Return the intervals of motion, (n, samples - 1), without those near the ends of motion."""
    turned = ~moving | (velocity[:, 1:] * velocity[:, :-1] <= 0.0)
    for _ in range(_REACH):
        near = turned.copy()
        near[:, 1:] |= turned[:, :-1]
        near[:, :-1] |= turned[:, 1:]
        turned = near
    return np.asarray(~turned)
