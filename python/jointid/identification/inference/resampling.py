"""The block bootstrap: stretches of the motion are drawn anew, and the parameters refitted to each draw.

A block is a run of neighbouring windows as long as a segment of motion (`segments`: the rule is fixed in advance);
it may begin at any quarter of one (moving blocks: Künsch 1989). The refit is the minimum of the penalty linearised at
the estimate, inside the bounds of the search: exact for all coefficients, to first order for shapes.
"""

from __future__ import annotations

import itertools

import numpy as np
from numpy.typing import NDArray

from jointid.base.values import dataclass
from jointid.recording.order_statistics import distinct

Array = NDArray[np.float64]
Whole = NDArray[np.int64]

CELLS = 4  # of a block, which begins at any of them
_DRAWS_AT_ONCE = 100
_TOGETHER, _ONE_BY_ONE = 12, 400  # exchanges between bounded and free
_RIDGE = 1e-12  # of a scaled direction: a draw may lack one altogether
_STEP = np.uint64(0x9E3779B97F4A7C15)


@dataclass(frozen=True, slots=True, kw_only=True)
class Cells:
    """The motion in quarters of blocks, and the penalty's sums over each.

    Attributes
    ----------
    square : ndarray, shape (cells, p, p)
        Products of the Jacobian's columns.
    gradient : ndarray, shape (cells, p)
        Their products with the residual.
    starts : ndarray of int
        Cells at which a block may begin.
    sure_square, sure_gradient : ndarray, shape (p, p) and (p,), optional
        The same sums of what is in every draw: known beforehand, and no motion. Default: nothing.
    """

    square: Array
    gradient: Array
    starts: Whole
    sure_square: Array | None = None
    sure_gradient: Array | None = None

    @property
    def blocks(self) -> int:
        """Blocks in a draw: as many as the motion holds."""
        return max(1, round(len(self.gradient) / CELLS))


def cells_of(
    jacobian: Array, residual: Array, moved: Array, recording: NDArray[np.integer], length: float
) -> Cells:
    """Cut the windows into cells of equal motion.

    Parameters
    ----------
    jacobian : ndarray, shape (windows, p)
    residual : ndarray, shape (windows,)
    moved : ndarray, shape (windows,)
        Motion in each window [s].
    recording : ndarray of int
        Of each window.
    length : float
        Of a block [s].
    """
    limits: list[tuple[int, int]] = []
    starts: list[int] = []
    for number in distinct(recording):
        first, last = np.searchsorted(recording, (number, number + 1))
        way = np.cumsum(moved[first:last])
        count = max(1, round(CELLS * float(way[-1]) / length))
        inner = 1 + np.searchsorted(way, way[-1] * np.arange(1, count) / count)
        cuts = distinct([0, *(i for i in inner if i < last - first), last - first]) + first
        # A recording shorter than a block is one with what follows.
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
    """Return the refitted changes of the parameters of each draw.

    Parameters
    ----------
    cells : Cells
    lower, upper : ndarray, shape (p,)
        How far each parameter may move: below 0 and above.
    count : int
    seed : int
        The same seed gives the same bits.

    Returns
    -------
    ndarray, shape (count, p)
    """
    result = np.empty((count, len(lower)))
    for first in range(0, count, _DRAWS_AT_ONCE):  # Ctrl-C comes between
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
    """How often each cell is in each draw."""
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
    """SplitMix64's finaliser, as in the core."""
    with np.errstate(over="ignore"):
        z = (z ^ (z >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
        z = (z ^ (z >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    return np.asarray(z ^ (z >> np.uint64(31)))


def bounded_minima(square: Array, gradient: Array, lower: Array, upper: Array) -> Array:
    """Return the minima of quadratic functions inside a box, all at once.

    Parameters
    ----------
    square : ndarray, shape (n, p, p)
    gradient : ndarray, shape (n, p)
        At zero.
    lower, upper : ndarray, shape (p,)

    Notes
    -----
    Parameters outside their bounds are held there, and held ones that the gradient pulls inside are
    freed: all together first, which ends in a few rounds nearly always; else one by one, the first one
    first, which ends always (Murty 1974; Júdice and Pires 1994).
    """
    count = square.shape[1]
    size = np.sqrt(np.einsum("nii->ni", square))
    size = np.where(size > 0.0, size, 1.0)
    scaled = square / (size[:, :, None] * size[:, None, :])
    scaled[:, np.arange(count), np.arange(count)] += _RIDGE
    slope = gradient / size
    low, high = lower * size, upper * size
    side = np.zeros(slope.shape)  # -1, 1: held at the lower, upper bound
    found = np.zeros(slope.shape)
    open_ = np.arange(len(slope))
    for step in range(_ONE_BY_ONE):
        at = np.where(side[open_] < 0.0, low[open_], high[open_])
        held = side[open_] != 0.0
        moved = _with_held(scaled[open_], slope[open_], held, np.where(held, at, 0.0))
        pull = np.einsum("nij,nj->ni", scaled[open_], moved) + slope[open_]
        pull = np.where(held, pull, 0.0)
        slack = 1e-9 * (1.0 + np.abs(moved))
        wanted = np.where(held, side[open_], 0.0)
        wanted = np.where(~held & (moved < low[open_] - slack), -1.0, wanted)
        wanted = np.where(~held & (moved > high[open_] + slack), 1.0, wanted)
        loose = 1e-9 * (1.0 + np.abs(slope[open_]))
        wanted = np.where(held & (side[open_] * pull > loose), 0.0, wanted)
        change = wanted != side[open_]
        found[open_] = moved
        if step >= _TOGETHER:  # the first one alone
            change &= np.cumsum(change, axis=1) == 1
        side[open_] = np.where(change, wanted, side[open_])
        open_ = open_[change.any(axis=1)]
        if open_.size == 0:
            break
    inside = np.clip(found / size, lower, upper)
    return np.where(side < 0.0, lower, np.where(side > 0.0, upper, inside))


def _with_held(square: Array, slope: Array, held: NDArray[np.bool_], at: Array) -> Array:
    """The minima over the free parameters, the held ones at their bounds."""
    fixed = held[:, :, None] | held[:, None, :]
    system = np.where(fixed, 0.0, square)
    index = np.arange(held.shape[1])
    system[:, index, index] = np.where(held, 1.0, square[:, index, index])
    right = -(slope + np.einsum("nij,nj->ni", square, at))
    right = np.where(held, at, right)
    return np.asarray(np.linalg.solve(system, right[:, :, None])[:, :, 0])
