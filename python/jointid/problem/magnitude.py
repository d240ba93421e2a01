"""Whether a torque is recorded without its sign: the magnitude of what a model's columns make, and not its value."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

CLEAR = 0.3  # of the torque: what may be left
BETTER = 0.25  # of a squared residual: what another reading of the signals has to leave
_NEGATIVE = 0.02  # of the largest torque: noise about 0
_TURNS = 10  # of signs and values


def is_one_sided(lowest: float, highest: float) -> bool:
    """Whether a torque between two values is never negative, noise apart."""
    return max(-lowest, 0.0) < _NEGATIVE * highest


def without(columns: Array, values: Array) -> Array:
    """Return values less what columns explain."""
    lengths = np.linalg.norm(columns, axis=0)
    basis, sizes, _ = np.linalg.svd(
        columns / np.where(lengths > 0.0, lengths, 1.0), full_matrices=False
    )
    basis = basis[:, sizes > 1e-6 * sizes[0]]
    return np.asarray(values - basis @ (basis.T @ values))


def is_magnitude(columns: Array, target: Array, starts: Iterable[Array]) -> bool:
    """Whether the rows are the magnitude of what columns make.

    Parameters
    ----------
    columns : ndarray, shape (n, p)
    target : ndarray, shape (n,)
    starts : iterable of ndarray, each of shape (n,)
        Signs of the torque to begin with, as a motion has them.
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
