"""Errors by drawing runs anew: what one run has in common does not average out within it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from jointid.servo.solving import NAMES, Sought, solved
from jointid.servo.windows import ServoGrid

Array = NDArray[np.float64]

_ENOUGH = 8  # runs, to draw whole ones
_PASSES = 2  # of a set, which starts next to its solution
_STRETCH = 1.0  # s; of a run, where runs are few


def units_of(grid: ServoGrid) -> NDArray[np.int64]:
    """Return the unit of resampling of each window: its run, or a stretch of it where there are few runs."""
    runs = np.unique(grid.run)
    if len(runs) >= _ENOUGH:
        return np.searchsorted(runs, grid.run).astype(np.int64)
    stretch = np.floor(grid.time / _STRETCH)
    key = grid.run * (1.0 + stretch.max()) + stretch
    return np.asarray(np.unique(key, return_inverse=True)[1], dtype=np.int64)


def drawn(products: Array, sought: Sought, values: Array, draws: int, seed: int) -> Array:
    """Return the parameters of sets of units that are drawn with replacement, shape (draws, 6).

    Parameters
    ----------
    products : ndarray, shape (units, columns, columns)
    sought : Sought
    values : ndarray, shape (6,)
        The solution of all units, from which each set starts.
    draws, seed : int
    """
    count = len(products)
    generator = np.random.default_rng(seed)
    times = generator.multinomial(count, np.full(count, 1.0 / count), size=draws).astype(float)
    sums = np.tensordot(times, products, axes=1)
    found = np.empty((draws, len(NAMES)))
    for k in range(draws):
        found[k] = solved(sums[k], sought, values, passes=_PASSES)
    return found
