"""The linear parameters of all joints in one solution; each joint is weighted by its own residual."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Self

import numpy as np
from numpy.typing import NDArray

from jointid.balance.least_squares import bounded_minima
from jointid.robot.balance.products import Products, powers, weighted

Array = NDArray[np.float64]
Whole = NDArray[np.int64]

_ROUNDS = 6  # rounds of weights and values; three are usually enough
_SETTLED = 1e-4


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class PriorRows:
    """Prior knowledge of the parameters: rows of unit variance in addition to the recording's rows."""

    matrix: Array  # (rows, parameters)
    target: Array  # (rows,)

    @classmethod
    def nothing(cls, count: int) -> Self:
        """Return an empty prior of `count` parameters."""
        return cls(matrix=np.zeros((0, count)), target=np.zeros(0))

    def padded(self, count: int) -> PriorRows:
        """Return the prior with `count` more parameters, without knowledge of them."""
        more = np.zeros((len(self.target), count))
        return PriorRows(matrix=np.hstack([self.matrix, more]), target=self.target)

    def tightened(self, factor: float) -> PriorRows:
        """Return the prior with a certainty multiplied by `factor`."""
        return PriorRows(matrix=factor * self.matrix, target=factor * self.target)

    def scaled(self, norms: Array) -> Array:
        """Return the prior's products, for columns and a target divided by these lengths."""
        rows = np.column_stack([self.matrix * (norms[-1] / norms[:-1]), self.target])
        return np.asarray(rows.T @ rows)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Solution:
    """Values of a bounded, weighted least-squares problem."""

    values: Array  # (parameters,), scaled
    at_bound: NDArray[np.bool_]  # (parameters,)
    # (joints,), root mean square of each joint's residuals, in units of the target's length
    scatter: Array


def solved(products: Products, least: Array, prior: PriorRows) -> Solution:
    """Return the best values above lower bounds; each joint is weighted by its own residuals."""
    sums = products.sums.sum(axis=0)
    prior_product = prior.scaled(products.norms)
    scatter = scatter_of(sums[:, -1, -1], products.counts)
    values, at_bound = np.zeros(least.size), np.zeros(least.size, dtype=bool)
    for _ in range(_ROUNDS):
        values, at_bound = above_bounds(weighted(sums, scatter) + prior_product, least)
        before, scatter = scatter, scatter_of(powers(sums, values), products.counts)
        if np.all(np.abs(scatter - before) <= _SETTLED * before):
            break
    return Solution(values=values, at_bound=at_bound, scatter=scatter)


def above_bounds(product: Array, least: Array) -> tuple[Array, NDArray[np.bool_]]:
    """Return the best values above lower bounds and a mask of those at a bound; the last column is the target."""
    columns, target = product[:-1, :-1], product[:-1, -1]
    values = bounded_minima(columns[None], -target[None], least, np.inf)[0]
    return values, (values == least) & (np.diag(columns) > 0.0)


def scatter_of(power: Array, count: Whole) -> Array:
    """Return the root mean square for each joint; 1 for a joint without rows."""
    rms = np.sqrt(power / np.maximum(count, 1))
    return np.where(rms > 0.0, rms, 1.0)
