"""Errors by resampling runs, because errors that a whole run has in common do not average out within it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from jointid.balance.resampling import drawn_units
from jointid.servo.layout import DRIVEN, LINEAR_COLUMN
from jointid.servo.solving import Unknowns, solved
from jointid.servo.windows import ServoGrid

Array = NDArray[np.float64]

_ENOUGH = 8  # smallest number of runs to resample whole runs
_SOME = 1e-9
_STRETCH = 1.0  # [s], stretch of a run that is resampled if there are few runs


def units_of(grid: ServoGrid) -> NDArray[np.int64]:
    """Return the unit of resampling of each window: its run, or a stretch of it if there are few runs."""
    runs = np.unique(grid.run)
    if len(runs) >= _ENOUGH:
        return np.searchsorted(runs, grid.run).astype(np.int64)
    stretch = np.floor(grid.time / _STRETCH)
    key = grid.run * (1.0 + stretch.max()) + stretch
    return np.asarray(np.unique(key, return_inverse=True)[1], dtype=np.int64)


def drawn(products: Array, unknowns: Unknowns, values: Array, draws: int, seed: int) -> Array:
    """Return the parameters of sets of units drawn with replacement, shape (at most draws, size).

    `products` is (units, columns, columns). Each set starts from `values`, the solution of all units.
    """
    times = drawn_units(len(products), draws, seed)
    if unknowns.separable and unknowns.layout.linear and not unknowns.motor_known:
        # A set must have a unit that turns freely and one that is driven, to separate back-EMF from friction.
        driven, turned = (products[:, each, each] for each in (DRIVEN, LINEAR_COLUMN))
        free = turned - driven > _SOME * turned
        times = times[
            (times[:, free].sum(axis=1) > 0.0) & (times[:, driven > 0.0].sum(axis=1) > 0.0)
        ]
    sums = np.tensordot(times, products, axes=1)
    return solved(sums, unknowns, np.tile(values, (len(sums), 1)))
