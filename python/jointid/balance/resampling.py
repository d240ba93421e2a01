"""Resampling: stretches of the motion are drawn with replacement (block bootstrap).

The parameters are refitted to each draw. A block is a run of neighbouring windows with the length of a segment of
motion (see `segments`). It may begin at any quarter of a segment (moving blocks: Künsch 1989). The refit minimizes
the penalty, linearised at the estimate, within the search bounds. It is exact for all coefficients, and first order
for shapes.
"""

from __future__ import annotations

import itertools

import numpy as np
from numpy.typing import NDArray

from jointid.balance.least_squares import bounded_minima
from jointid.base.values import dataclass
from jointid.recording.order_statistics import distinct

Array = NDArray[np.float64]
Whole = NDArray[np.int64]

CELLS = 4  # cells per block; a block may begin at any cell
_DRAWS_AT_ONCE = 100
_STEP = np.uint64(0x9E3779B97F4A7C15)


@dataclass(frozen=True, slots=True, kw_only=True)
class Cells:
    """The motion in quarters of blocks (cells), and the sums of the penalty over each.

    Attributes
    ----------
    square : ndarray, shape (cells, p, p)
        Products of the Jacobian's columns.
    gradient : ndarray, shape (cells, p)
        Products of the Jacobian's columns with the residual.
    starts : ndarray of int
        Cells at which a block may begin.
    sure_square, sure_gradient : ndarray, shape (p, p) and (p,), optional
        The same sums of prior knowledge, which is in every draw. Default: none.
    """

    square: Array
    gradient: Array
    starts: Whole
    sure_square: Array | None = None
    sure_gradient: Array | None = None

    @property
    def blocks(self) -> int:
        """Number of blocks per draw: the number that the motion holds."""
        return max(1, round(len(self.gradient) / CELLS))


def cells_of(
    jacobian: Array,
    residual: Array,
    recording: NDArray[np.integer],
    begin: Array,
    end: Array,
    length: float,
) -> Cells:
    """Cut rows into cells of equal motion.

    Parameters
    ----------
    jacobian : ndarray, shape (rows, p)
    residual : ndarray, shape (rows,)
    recording : ndarray of int
        Recording of each row, ascending.
    begin, end : ndarray, shape (rows,)
        Motion before each row and with it [s], ascending.
    length : float
        Length of a block [s].
    """
    limits: list[tuple[int, int]] = []
    starts: list[int] = []
    for number in distinct(recording):
        first, last = np.searchsorted(recording, (number, number + 1))
        span = float(end[first:last].max() - begin[first])
        count = max(1, round(CELLS * span / length))
        ends = begin[first] + span * np.arange(1, count) / count
        inner = np.searchsorted(begin[first:last], ends)
        cuts = distinct([0, *(i for i in inner if i < last - first), last - first]) + first
        # A recording shorter than a block is joined with the next one.
        starts += range(len(limits), len(limits) + max(1, len(cuts) - CELLS))
        limits += [(int(a), int(b)) for a, b in itertools.pairwise(cuts)]
    count = len(limits)
    square = np.empty((count, jacobian.shape[1], jacobian.shape[1]))
    gradient = np.empty((count, jacobian.shape[1]))
    for i, (first, last) in enumerate(limits):
        rows = jacobian[first:last]
        square[i] = np.einsum("ij,ik->jk", rows, rows)
        gradient[i] = np.einsum("ij,i->j", rows, residual[first:last])
    inside = [start for start in starts if start + CELLS <= count] or [0]
    return Cells(square=square, gradient=gradient, starts=np.array(inside))


def draws(cells: Cells, lower: Array, upper: Array, count: int, seed: int) -> Array:
    """Return the changes of the parameters, refitted to each draw.

    Parameters
    ----------
    cells : Cells
    lower, upper : ndarray, shape (p,)
        Bounds of each parameter's change: lower is below 0, upper above.
    count : int
    seed : int
        The same seed gives the same bits.

    Returns
    -------
    ndarray, shape (count, p)
    """
    result = np.empty((count, len(lower)))
    for first in range(0, count, _DRAWS_AT_ONCE):  # allows Ctrl-C between batches
        last = min(count, first + _DRAWS_AT_ONCE)
        weight = _weights(cells, first, last, seed)
        square = np.einsum("nc,cij->nij", weight, cells.square)
        gradient = np.einsum("nc,ci->ni", weight, cells.gradient)
        if cells.sure_square is not None:
            square += cells.sure_square
        if cells.sure_gradient is not None:
            gradient += cells.sure_gradient
        result[first:last] = bounded_minima(square, gradient, lower, upper)
    return result


def _weights(cells: Cells, first: int, last: int, seed: int) -> Array:
    """Return how often each cell is in each draw."""
    places = np.arange(first, last, dtype=np.uint64)[:, None] << np.uint64(32)
    counter = places + np.arange(cells.blocks, dtype=np.uint64)[None, :] + np.uint64(1)
    start = _mixed(np.array(seed, dtype=np.uint64) + _STEP)
    with np.errstate(over="ignore"):
        drawn = (_mixed(start + counter * _STEP) >> np.uint64(32)) * np.uint64(len(cells.starts))
    begin = cells.starts[(drawn >> np.uint64(32)).astype(np.int64)]
    total = len(cells.gradient)
    steps = np.zeros((last - first, total + CELLS + 1))
    row = np.arange(last - first)[:, None]
    np.add.at(steps, (row, begin), 1.0)
    np.add.at(steps, (row, begin + CELLS), -1.0)
    return np.cumsum(steps, axis=1)[:, :total]


def _mixed(z: NDArray[np.uint64]) -> NDArray[np.uint64]:
    """Return SplitMix64's finaliser, same as in the core."""
    with np.errstate(over="ignore"):
        z = (z ^ (z >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
        z = (z ^ (z >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    return np.asarray(z ^ (z >> np.uint64(31)))


def drawn_units(units: int, draws: int, seed: int) -> Array:
    """Return how often each unit is in each draw of `units` units with replacement, shape (draws, units)."""
    generator = np.random.default_rng(seed)
    return generator.multinomial(units, np.full(units, 1.0 / units), size=draws).astype(float)
