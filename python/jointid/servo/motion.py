"""A servo's motion from its position alone, because the logged velocity is late by tens of milliseconds."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_ENOUGH = 4  # smallest number of samples of a span; three different instants determine a parabola


def local_quadratic(time: Array, values: Array, at: Array, half: float) -> tuple[Array, Array]:
    """Return value and slope at each instant, from a parabola through the samples within `half` [s] of it."""
    first = np.searchsorted(time, at - half - 1e-9)
    last = np.searchsorted(time, at + half + 1e-9)
    widest = int((last - first).max())
    index = first[:, None] + np.arange(widest)
    inside = index < last[:, None]
    index = np.minimum(index, len(time) - 1)
    weight = inside.astype(float)
    x = (time[index] - at[:, None]) * (weight / half)
    y = values[index] * weight
    square = x * x
    count = weight.sum(axis=1)
    one, two = x.sum(axis=1), square.sum(axis=1)
    three, four = (square * x).sum(axis=1), (square * square).sum(axis=1)
    right = (y.sum(axis=1), (x * y).sum(axis=1), (square * y).sum(axis=1))
    # The inverse of the normal equations' symmetric 3 x 3 matrix, by its cofactors.
    a = two * four - three * three
    b = two * three - one * four
    c = one * three - two * two
    d = count * four - two * two
    e = one * two - count * three
    with np.errstate(divide="ignore", invalid="ignore"):
        scale = 1.0 / (count * a + one * b + two * c)
        value = scale * (a * right[0] + b * right[1] + c * right[2])
        slope = scale * (b * right[0] + d * right[1] + e * right[2])
    # If a gap leaves too few samples, the span has no slope.
    poor = (count < _ENOUGH) | ~np.isfinite(value) | ~np.isfinite(slope)
    value[poor] = slope[poor] = 0.0
    return value, slope / half


def smoothed(values: Array, reach: int) -> Array:
    """Return an even signal as the mean with the weights that a parabola's slope gives to the velocity.

    The slope over a half span h weights the velocity at a distance x by 1 - (x / h)². `reach` is h in grid steps. The
    first and last values are continued.
    """
    x = np.arange(-reach, reach + 1) / reach
    weights = 1.0 - x * x
    padded = np.concatenate((np.full(reach, values[0]), values, np.full(reach, values[-1])))
    return np.convolve(padded, weights / weights.sum(), mode="valid")
