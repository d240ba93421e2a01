"""Least squares on columns of a triangle, the R of a QR decomposition of what was measured."""

import numpy as np
from numpy.typing import NDArray

from jointid import _core

Array = NDArray[np.float64]


def solve(
    triangle: Array, columns: list[int], target: int, rcond: float = 1e-10
) -> tuple[Array, float]:
    """Return the least-squares coefficients of some columns for another one, and the norm of what they leave.

    Parameters
    ----------
    triangle : ndarray, shape (rows, columns)
        Of the core, column by column in memory.
    columns : list of int
    target : int
    rcond : float
        Of the columns, brought to unit norm: below it they are combinations of each other. Default 1e-10.
    """
    solved = _core.solve_independent(triangle, columns, target)
    if solved is not None:
        return np.asarray(solved[0]), solved[1]
    regressors, wanted = triangle[:, columns], triangle[:, target]
    norms = np.linalg.norm(regressors, axis=0)
    scale = np.where(norms > 0.0, norms, 1.0)
    found = np.linalg.lstsq(regressors / scale, wanted, rcond=rcond)[0] / scale
    return found, float(np.linalg.norm(wanted - regressors @ found))
