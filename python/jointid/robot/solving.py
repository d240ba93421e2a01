"""The linear parameters of all joints at once, each joint weighted by its own residual."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Self

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.identification.inference.segments import Segments, usual_length
from jointid.robot.products import Products, powers, root_of, weighted

Array = NDArray[np.float64]
Whole = NDArray[np.int64]

_ROUNDS = 6  # of weights and values; they settle within three
_SETTLED = 1e-4
_ALIKE = 1e-10  # of the largest singular value: smaller ones are rounding


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
        values, at_bound = bounded(weighted(sums, scatter) + prior_product, least)
        before, scatter = scatter, scatter_of(powers(sums, values), products.counts)
        if np.all(np.abs(scatter - before) <= _SETTLED * before):
            break
    return Solution(values=values, at_bound=at_bound, scatter=scatter)


def bounded(product: Array, least: Array) -> tuple[Array, NDArray[np.bool_]]:
    """Return the least-squares values above lower bounds, and which are at them.

    `product` is of the columns and, last, the target; bounds are 0 or minus infinity, which no scale changes.
    """
    count = least.size
    present = np.flatnonzero(np.diag(product)[:count] > 0.0)
    values, at_bound = np.zeros(count), np.zeros(count, dtype=bool)
    if not present.size:
        return values, at_bound
    root = root_of(product[np.ix_(np.append(present, count), np.append(present, count))])
    left, right = root[:, :-1], root[:, -1]
    free = np.linalg.lstsq(left, right, rcond=_ALIKE)[0]
    lower = least[present]
    if np.any(free < lower):
        free = _above_zero(left, right, lower == 0.0)
        at_bound[present] = (lower == 0.0) & (free == 0.0)
    values[present] = free
    return values, at_bound


def _above_zero(left: Array, right: Array, limited: NDArray[np.bool_]) -> Array:
    """The least-squares values of which the limited ones are not negative.

    What the others can explain is taken out of the limited columns and the target; the others follow.
    """
    others, wanted = left[:, ~limited], left[:, limited]
    basis, sizes, _ = np.linalg.svd(others, full_matrices=False)
    basis = basis[:, sizes > _ALIKE * max(sizes, default=0.0)]
    unexplained = wanted - basis @ (basis.T @ wanted)
    # A column that the others explain has no value of its own.
    length, before = np.linalg.norm(unexplained, axis=0), np.linalg.norm(wanted, axis=0)
    unexplained[:, length <= _ALIKE * before] = 0.0
    values = np.zeros(left.shape[1])
    values[limited], _ = _core.non_negative_least_squares(
        unexplained, right - basis @ (basis.T @ right)
    )
    rest = right - wanted @ values[limited]
    values[~limited] = np.linalg.lstsq(others, rest, rcond=_ALIKE)[0]
    return values


def scatter_of(power: Array, count: Whole) -> Array:
    """Root mean square by joint; of nothing 1."""
    rms = np.sqrt(power / np.maximum(count, 1))
    return np.where(rms > 0.0, rms, 1.0)


def time_segments(start: Array, stop: Array, piece: Whole) -> Segments:
    """Return segments of equal duration over rows in the order of time: all joints of a stretch are one.

    What one joint's model misses acts on its neighbours in the same stretch.
    """
    first, spans = _spans(start, stop, piece)
    length = usual_length(sum(spans))
    cuts, between = [0], [0]
    for low, high, span in zip(first, [*first[1:], len(start)], spans, strict=True):
        count = max(1, round(span / length))
        for shift, found in ((0.0, cuts), (0.5, between)):
            ends = start[low] + span * (np.arange(1, count) - shift) / count
            found += [int(low + each) for each in np.searchsorted(start[low:high], ends)]
            found.append(int(high))
    return Segments(length=length, cuts=(np.unique(cuts), np.unique(between)))


def segment_length(start: Array, stop: Array, piece: Whole) -> float:
    """Return what a segment of rows in the order of time should last [s]."""
    return usual_length(sum(_spans(start, stop, piece)[1]))


def _spans(start: Array, stop: Array, piece: Whole) -> tuple[Whole, list[float]]:
    """First row of each piece, and how long each lasts [s]."""
    first = np.flatnonzero(np.diff(piece, prepend=-1))
    spans = [
        float(stop[low:high].max() - start[low])
        for low, high in zip(first, [*first[1:], len(start)], strict=True)
    ]
    return first, spans
