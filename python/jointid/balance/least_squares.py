"""Linear least squares: on columns of a triangle, within bounds, and for many problems at once."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from jointid import _core

Array = NDArray[np.float64]


def solve(
    triangle: Array, columns: list[int], target: int, rcond: float = 1e-10
) -> tuple[Array, float]:
    """Return the least-squares coefficients of these columns for the target column, and the norm of the residual.

    Parameters
    ----------
    triangle : ndarray, shape (rows, columns)
        Triangle from the core, in column-major order.
    columns : list of int
    target : int
    rcond : float
        Smallest relative singular value of columns at unit norm; below it, columns are dependent. Default 1e-10.
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
    """Return the minima of several quadratic functions within bounds.

    Parameters
    ----------
    square : ndarray, shape (n, p, p)
    gradient : ndarray, shape (n, p)
        Gradient at zero.
    lower, upper : array_like, shape (p,) or a number
        Bounds; infinite for none.

    Returns
    -------
    ndarray, shape (n, p)
        Minima. A parameter at a bound equals the bound exactly. Undetermined directions have the shortest solution.
    """
    count = gradient.shape[1]
    low, high = (np.broadcast_to(np.asarray(each, float), count) for each in (lower, upper))
    return _core.box_minima(square, gradient, low, high)
