"""Median, quantiles and distinct numbers.

NumPy's functions import numpy.ma to check for masks. This import takes a third of NumPy's own import time.
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray


def median(values: ArrayLike) -> float:
    """Return the median of all numbers of an array, identical to `numpy.median` bit for bit.

    Parameters
    ----------
    values : array_like
        Any shape.

    Returns
    -------
    float
        NaN if the array holds a NaN or is empty.
    """
    flat = np.asarray(values, dtype=np.float64).ravel()
    if not len(flat):
        return float("nan")
    half = len(flat) // 2
    places = (half,) if len(flat) % 2 else (half - 1, half)
    parted = np.partition(flat, (*places, len(flat) - 1))  # NaN come last
    if np.isnan(parted[-1]):
        return float("nan")
    return sum(float(parted[place]) for place in places) / len(places)


def quantile(values: ArrayLike, share: float) -> float:
    """Return a quantile of all numbers of an array, identical to `numpy.quantile` bit for bit.

    Parameters
    ----------
    values : array_like
        Any shape; at least one number.
    share : float
        Order of the quantile, 0 to 1; interpolated between two numbers.

    Returns
    -------
    float
        NaN if there is a NaN.
    """
    return _quantile(np.array(values, dtype=np.float64).ravel(), share)


def quantile_of_sizes(values: ArrayLike, share: float) -> float:
    """Return a quantile of the magnitudes of an array; this needs one copy of the array.

    Parameters
    ----------
    values : array_like
        Any shape; at least one number.
    share : float
        Same as in `quantile`.

    Returns
    -------
    float
        NaN if there is a NaN.
    """
    return _quantile(np.abs(np.asarray(values, dtype=np.float64)).ravel(), share)


def _quantile(parted: NDArray[np.float64], share: float) -> float:
    """Return the quantile of an array; changes the array's order."""
    place = (len(parted) - 1) * share
    low = min(int(place), len(parted) - 1)
    high = min(low + 1, len(parted) - 1)
    parted.partition((low, high, len(parted) - 1))  # NaN come last
    if np.isnan(parted[-1]):
        return float("nan")
    below, above, part = float(parted[low]), float(parted[high]), place - low
    step = above - below
    return above - step * (1.0 - part) if part >= 0.5 else below + step * part


def distinct(values: ArrayLike) -> NDArray[np.int64]:
    """Return the distinct whole numbers of an array, sorted.

    Parameters
    ----------
    values : array_like of int
        Any shape.

    Returns
    -------
    ndarray of int64
        Same as from `numpy.unique`.
    """
    ordered = np.sort(np.asarray(values, dtype=np.int64), axis=None)
    first = np.ones(len(ordered), dtype=np.bool_)
    np.not_equal(ordered[1:], ordered[:-1], out=first[1:])
    return ordered[first]
