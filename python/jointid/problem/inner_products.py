"""Inner products of window series without BLAS.

BLAS uses its own threads for long vectors. They spin for tens of milliseconds and slow down the core's threads.
Their number also changes the last bits of a result.
"""

import math

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def inner(one: Array, other: Array) -> float:
    """Return the sum of products of two series."""
    return float(np.add.reduce(one * other))


def size(series: Array) -> float:
    """Return the Euclidean norm."""
    return math.sqrt(inner(series, series))


def column_sizes(matrix: Array) -> Array:
    """Return the Euclidean norm of each column of a matrix."""
    return np.asarray(np.sqrt(np.add.reduce(matrix * matrix, axis=0)))


def columns_with(matrix: Array, series: Array) -> Array:
    """Return the inner product of each column of a matrix, shape (rows, p), with a series."""
    return np.asarray(np.einsum("ij,i->j", matrix, series))
