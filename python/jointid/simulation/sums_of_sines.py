"""Largest values of sums of sines."""

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]

_AT_ONCE = 1_000_000  # samples of all sines in one array


def peak_of_sines(rate: FloatArray, phase: FloatArray, duration: float, count: int) -> float:
    """Return a sum's largest deviation from its start, in `count` samples from 0 to `duration` [s]."""
    step, part = duration / (count - 1), max(1, _AT_ONCE // len(rate))
    first, largest = np.sin(phase).sum(), 0.0
    for start in range(0, count, part):
        time = np.arange(start, min(start + part, count)) * step
        if start + part >= count:
            time[-1] = duration
        shape = np.sin(np.outer(time, rate) + phase).sum(axis=1) - first
        largest = max(largest, float(np.abs(shape).max()))
    return largest
