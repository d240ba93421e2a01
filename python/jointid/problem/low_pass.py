"""A low-pass filter without delay: three moving averages."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

PASSES = 3


def low_passed(values: Array, width: int) -> Array:
    """Return values after three moving averages; the end values continue beyond the ends.

    Parameters
    ----------
    values : ndarray, shape (..., samples)
    width : int
        Samples per average; made odd, so that there is no delay. The filter uses `reach(width)` samples per side.
    """
    half = max(0, int(width) // 2)
    if not half:
        return values
    for _ in range(PASSES):
        ends = [np.repeat(values[..., [place]], half, axis=-1) for place in (0, -1)]
        middle = values.mean(axis=-1, keepdims=True)  # without the mean, sums lose no digits
        padded = np.concatenate([ends[0], values, ends[1]], axis=-1) - middle
        total = np.cumsum(padded, axis=-1)
        total = np.concatenate([np.zeros_like(total[..., :1]), total], axis=-1)
        span = 2 * half + 1
        values = (total[..., span:] - total[..., :-span]) / span + middle
    return values


def reach(width: int) -> int:
    """Return the number of samples that the filter uses on each side."""
    return PASSES * max(0, int(width) // 2)
