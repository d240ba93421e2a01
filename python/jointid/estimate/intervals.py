"""Confidence intervals of quantities from several parameters."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from jointid.estimate.record import EstimateRecord
from jointid.estimate.statistics import ParameterEstimate

Array = NDArray[np.float64]

NORMAL = 1.959964
"""Standard errors in half of a 95 % interval."""

_TINY = 1e-100  # a file may hold any number


BESIDE = ("given", "residual_side")  # systematic parts outside all intervals


def interval_part(p: ParameterEstimate) -> float:
    """Return the total of the systematic parts within a parameter's interval, as one standard error."""
    return math.hypot(*(size for name, size in p.systematic.items() if name not in BESIDE))


def quantile_of(estimate: EstimateRecord) -> float:
    """Return the largest quantile of the parameters' intervals, in standard errors; at least the normal one."""
    found = [NORMAL]
    for p in estimate.parameters.values():
        if p.interval is not None and p.stderr is not None and _TINY < p.stderr < np.inf:
            error = math.hypot(p.stderr, interval_part(p))
            found.append(0.5 * (p.interval[1] - p.interval[0]) / error)
    return max(found)


def half_widths(estimate: EstimateRecord, *, without: str = "") -> Array:
    """Return half of each free parameter's interval in random standard errors; at least the normal quantile.

    Each parameter's interval has its own quantile and systematic parts; the part `without` is left out.
    """
    scale = np.full(len(estimate.free), NORMAL)
    quantile = quantile_of(estimate)
    for i, name in enumerate(estimate.free):
        p = estimate.parameters[name]
        if p.interval is not None and p.stderr is not None and _TINY < p.stderr < np.inf:
            error = math.hypot(p.stderr, interval_part(p))
            left_out = p.systematic.get(without, 0.0)
            share = math.sqrt(max(0.0, 1.0 - (left_out / error) ** 2))
            scale[i] = share * 0.5 * (p.interval[1] - p.interval[0]) / p.stderr
        elif p.stderr == np.inf:
            # Parameters that no recording separates are known as sums; the covariance is for a fixed offset.
            chance = float(np.sqrt(max(estimate.covariance[i, i], 0.0)))
            if _TINY < chance < np.inf:
                scale[i] = quantile * np.hypot(chance, interval_part(p)) / chance
    return scale


def squared_half_widths(estimate: EstimateRecord) -> Array:
    """Return the covariance of the free parameters, scaled so that its diagonal holds squared half widths.

    The correlations are those of the covariance.
    """
    scale = half_widths(estimate)
    return np.asarray(estimate.covariance * np.outer(scale, scale))
