"""Detection of a torque that is recorded without its sign: it fits the magnitude of a model's torque, not its value."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

CLEAR = 0.3  # largest residual over the torque
BETTER = 0.25  # largest squared residual of another interpretation, over that of the present one
_NEGATIVE = 0.02  # over the largest torque: noise around 0
_TURNS = 10  # alternations between signs and values


def is_one_sided(lowest: float, highest: float) -> bool:
    """Whether a torque in this range is never negative, except for noise."""
    return max(-lowest, 0.0) < _NEGATIVE * highest


def without(columns: Array, values: Array) -> Array:
    """Return values minus the part that the columns explain."""
    lengths = np.linalg.norm(columns, axis=0)
    basis, sizes, _ = np.linalg.svd(
        columns / np.where(lengths > 0.0, lengths, 1.0), full_matrices=False
    )
    basis = basis[:, sizes > 1e-6 * sizes[0]]
    return np.asarray(values - basis @ (basis.T @ values))


def is_magnitude(columns: Array, target: Array, starts: Iterable[Array]) -> bool:
    """Whether the target is the magnitude of a linear combination of the columns.

    Parameters
    ----------
    columns : ndarray, shape (n, p)
    target : ndarray, shape (n,)
    starts : iterable of ndarray, each of shape (n,)
        Initial signs of the torque, e.g. of the motion.
    """
    plain = np.sum(without(columns, target) ** 2)
    best = np.inf
    for start in starts:
        sign = np.where(start < 0.0, -1.0, 1.0)
        for _ in range(_TURNS):
            rest = without(columns, sign * target)
            sign = np.where(sign * target - rest < 0.0, -1.0, 1.0)
        best = min(best, float(np.sum(without(columns, sign * target) ** 2)))
    return bool(best < BETTER * plain and best < CLEAR**2 * float(target @ target))
