"""The linear parameters of all joints at once, each joint weighted by its own residual."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Self

import numpy as np
from numpy.typing import NDArray

from jointid.balance.least_squares import bounded_minima
from jointid.robot.balance.products import Products, powers, weighted

Array = NDArray[np.float64]
Whole = NDArray[np.int64]

_ROUNDS = 6  # of weights and values; they settle within three
_SETTLED = 1e-4


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class PriorRows:
    """What is known of the parameters beforehand: rows of unit variance, besides those of the recording."""

    matrix: Array  # (rows, parameters)
    target: Array  # (rows,)

    @classmethod
    def nothing(cls, count: int) -> Self:
        """Nothing is known of so many parameters."""
        return cls(matrix=np.zeros((0, count)), target=np.zeros(0))

    def padded(self, count: int) -> PriorRows:
        """The same, with further parameters of which nothing is known."""
        more = np.zeros((len(self.target), count))
        return PriorRows(matrix=np.hstack([self.matrix, more]), target=self.target)

    def tightened(self, factor: float) -> PriorRows:
        """The same, as many times as certain."""
        return PriorRows(matrix=factor * self.matrix, target=factor * self.target)

    def scaled(self, norms: Array) -> Array:
        """Its products, for columns and a target that are divided by these lengths."""
        rows = np.column_stack([self.matrix * (norms[-1] / norms[:-1]), self.target])
        return np.asarray(rows.T @ rows)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Solution:
    """Values of a bounded, weighted least-squares problem."""

    values: Array  # (parameters,), as scaled
    at_bound: NDArray[np.bool_]  # (parameters,)
    # (joints,), root mean square of each one's residuals, in units of the target's length
    scatter: Array


def solved(products: Products, least: Array, prior: PriorRows) -> Solution:
    """Return the values above lower bounds that fit best, with the weight of each joint from its own residuals."""
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
    """Return the values above lower bounds, and which are at them; the last column of `product` is the target."""
    columns, target = product[:-1, :-1], product[:-1, -1]
    values = bounded_minima(columns[None], -target[None], least, np.inf)[0]
    return values, (values == least) & (np.diag(columns) > 0.0)


def scatter_of(power: Array, count: Whole) -> Array:
    """Root mean square by joint; of nothing 1."""
    rms = np.sqrt(power / np.maximum(count, 1))
    return np.where(rms > 0.0, rms, 1.0)
