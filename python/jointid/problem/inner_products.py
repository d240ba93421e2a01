"""Inner products of window series without BLAS.

BLAS hands long vectors to threads of its own, which go on spinning for tens of milliseconds beside the core's, and the
number of which changes the last bits.
"""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def inner(one: Array, other: Array) -> float:
    """Sum of products of two series."""
    return float(np.einsum("i,i->", one, other))


def size(series: Array) -> float:
    """Euclidean norm."""
    return float(np.sqrt(np.einsum("i,i->", series, series)))


def columns_with(matrix: Array, series: Array) -> Array:
    """Inner product of each column, shape (rows, p), with a series."""
    return np.asarray(np.einsum("ij,i->j", matrix, series))
