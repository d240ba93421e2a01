"""95 % interval of a value on its bound, computed without the bound."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from jointid.balance.covariance import Triangle, parameter_covariance
from jointid.balance.segments import Segments
from jointid.estimate.student import quantile

Array = NDArray[np.float64]


def held_intervals(
    jacobian: Array,
    residual: Array,
    kept: list[int],
    held: dict[int, float],
    segments: Segments | None,
    threads: int = 0,
) -> dict[int, tuple[float, float]]:
    """Return the interval of each coefficient on a bound, by one least-squares step with this coefficient free.

    Each coefficient is freed alone, because two that the motion hardly separates may both be on a bound.

    Parameters
    ----------
    jacobian : ndarray, shape (windows, p)
        Derivatives of the residuals by all parameters.
    kept : list of int
        Indices of the free parameters.
    held : mapping of int to float
        Index and value of each coefficient on a bound.
    """
    found = {}
    for index, value in held.items():
        columns = jacobian[:, [*kept, index]]
        count = columns.shape[1]
        triangle = Triangle(np.column_stack([columns, residual]), threads)
        own = triangle.matrix[:count, :count]
        step = triangle.solve(list(range(count)), count, rcond=1e-10)[0]
        left = residual - np.einsum("ij,j->i", columns, step)  # without the effect of the bound
        spread = parameter_covariance(columns, left, None, own, threads=threads, segments=segments)
        error = float(spread.stderr[-1])
        if math.isfinite(error):
            best = value - float(step[-1])
            half = quantile(0.975, float(spread.freedom[-1])) * error
            found[index] = (best - half, best + half)
        else:
            found[index] = (-math.inf, math.inf)
    return found
