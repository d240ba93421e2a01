"""Fast test at several scales whether residuals are more than noise, before the search for causes."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from jointid.identification.causes.folds import summed
from jointid.problem.inner_products import inner
from jointid.recording.order_statistics import quantile

Array = NDArray[np.float64]

_SCALES = (1, 4, 16)
_CORRELATED = 0.1
_SURE = 4.0  # correlation over its standard error for noise
_FEWEST = 40  # sums of windows
_SLOW = 0.2  # share of the windows that count as slow
_LOUD = 3.0  # mean squared residual of the slow windows over that of the others


def correlations(residual: Array, run: NDArray[np.int64]) -> dict[int, float]:
    """Return the correlation of neighboring sums of 1, 4 and 16 windows, by scale; scales with few sums are missing."""
    found = {}
    for factor in _SCALES:
        series, of = summed(residual, run, factor)
        if len(series) >= _FEWEST:
            later, earlier = series[1:], series[:-1]
            if of[0] != of[-1]:
                pairs = of[1:] == of[:-1]
                later, earlier = later[pairs], earlier[pairs]
            found[factor] = inner(later, earlier) / max(inner(series, series), 1e-300)
    return found


def suspicious(residual: Array, run: NDArray[np.int64], duration: Array, velocity: Array) -> bool:
    """Return whether the residual has structure: correlated neighbors at a scale, or a large residual in slow motion.

    Parameters
    ----------
    velocity : ndarray
        Mean velocity of each window.
    """
    return correlated(residual, run) or slow_misfit(residual, duration, velocity) > _LOUD


def correlated(residual: Array, run: NDArray[np.int64]) -> bool:
    """Return whether neighbors are correlated at a scale."""
    for factor, correlation in correlations(residual, run).items():
        error = 1.0 / np.sqrt(len(residual) / factor)
        if correlation > max(_CORRELATED, _SURE * error):
            return True
    return False


def testable(run: NDArray[np.int64]) -> bool:
    """Return whether there are enough windows to distinguish noise from structure."""
    return len(run) >= _FEWEST


def slow_misfit(residual: Array, duration: Array, velocity: Array) -> float:
    """Return the mean squared residual of the slowest windows over that of the others."""
    if len(residual) < 5 * _FEWEST:
        return 1.0
    speed = np.abs(velocity)
    slow = speed < quantile(speed, _SLOW)
    count = int(np.count_nonzero(slow))
    power = residual * residual / duration
    others = float(power[~slow].sum()) / (len(power) - count)
    return float(power[slow].sum()) / count / others if count and others > 0.0 else 1.0
