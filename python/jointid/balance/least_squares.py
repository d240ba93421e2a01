"""Linear least squares: on columns of a triangle, inside bounds, and of many problems at once."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from jointid import _core

Array = NDArray[np.float64]


def solve(
    triangle: Array, columns: list[int], target: int, rcond: float = 1e-10
) -> tuple[Array, float]:
    """Return the least-squares coefficients of some columns for another one, and the norm of what they leave.

    Parameters
    ----------
    triangle : ndarray, shape (rows, columns)
        Triangle of the core, column by column in memory.
    columns : list of int
    target : int
    rcond : float
        Smallest relative singular value of the columns at unit norm; columns below it are dependent. Default 1e-10.
    """
    solved = _core.solve_independent(triangle, columns, target)
    if solved is not None:
        return np.asarray(solved[0]), solved[1]
    regressors, wanted = triangle[:, columns], triangle[:, target]
    norms = np.linalg.norm(regressors, axis=0)
    scale = np.where(norms > 0.0, norms, 1.0)
    found = np.linalg.lstsq(regressors / scale, wanted, rcond=rcond)[0] / scale
    return found, float(np.linalg.norm(wanted - regressors @ found))


def bounded_minima(square: Array, gradient: Array, lower: ArrayLike, upper: ArrayLike) -> Array:
    """Return the minima of quadratic functions inside a box, all at once.

    Parameters
    ----------
    square : ndarray, shape (n, p, p)
    gradient : ndarray, shape (n, p)
        At zero.
    lower, upper : array_like, shape (p,) or a number
        Bounds; infinite where there are none.

    Returns
    -------
    ndarray, shape (n, p)
        A parameter at a bound is exactly that bound. Of a direction that a problem lacks, the shortest solution.
    """
    count = gradient.shape[1]
    low, high = (np.broadcast_to(np.asarray(each, float), count) for each in (lower, upper))
    return _core.box_minima(square, gradient, low, high)
