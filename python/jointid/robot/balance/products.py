"""Products of the columns of all joints' rows: the input of every solution, independent of the recording's length.

The rows are read only once. After that, least squares costs the same for any weights of the joints, any omitted
columns and any held-out stretch of time. Columns are scaled to unit length, because products square the condition
number.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Self

import numpy as np
from numpy.typing import NDArray

from jointid.robot.balance.balance import Rows

Array = NDArray[np.float64]
Whole = NDArray[np.int64]

FOLDS = 8  # number of stretches of time that are held out in turn


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Products:
    """Columns and target of all joints."""

    blocks: tuple[Array, ...]  # scaled columns of each joint's rows; the target is the last one
    places: tuple[Whole, ...]  # row numbers of each joint
    folds: tuple[Whole, ...]  # stretch of time of each row
    norms: Array  # lengths of the columns and of the target, used as divisors
    sums: Array  # (FOLDS, joints, columns + 1, columns + 1), products by stretch and joint

    @classmethod
    def of(cls, blocks: list[Array], places: list[Whole], rows: Rows) -> Self:
        """Return the products of unscaled blocks. The blocks are scaled in place."""
        power = sum((np.einsum("ij,ij->j", each, each) for each in blocks), np.zeros(1))
        norms = np.sqrt(np.where(power > 0.0, power, 1.0))
        stretch = folds_of(rows)
        width = norms.size
        sums = np.zeros((FOLDS, len(blocks), width, width))
        folds = [stretch[place] for place in places]
        for joint, block in enumerate(blocks):
            block /= norms
            edges = np.searchsorted(folds[joint], np.arange(FOLDS + 1))
            for fold in range(FOLDS):
                mine = block[edges[fold] : edges[fold + 1]]
                sums[fold, joint] = mine.T @ mine
        return cls(
            blocks=tuple(blocks), places=tuple(places), folds=tuple(folds), norms=norms, sums=sums
        )

    @property
    def columns(self) -> int:
        """Number of columns, without the target."""
        return self.norms.size - 1

    @property
    def counts(self) -> Whole:
        """Number of rows of each joint."""
        return np.array([place.size for place in self.places])

    def with_columns(self, added: dict[int, Array]) -> Array:
        """Return the products with further columns of some joints before the target, (FOLDS, joints, size, size)."""
        count = sum(each.shape[1] for each in added.values())
        old = self.columns
        size = old + count + 1
        found = np.zeros((FOLDS, len(self.blocks), size, size))
        kept = np.append(np.arange(old), size - 1)
        found[:, :, kept[:, None], kept] = self.sums
        first = old
        for joint, columns in added.items():
            mine = np.arange(first, first + columns.shape[1])
            first += columns.shape[1]
            edges = np.searchsorted(self.folds[joint], np.arange(FOLDS + 1))
            for fold in range(FOLDS):
                part = slice(edges[fold], edges[fold + 1])
                across = self.blocks[joint][part].T @ columns[part]
                matrix = found[fold, joint]
                matrix[np.ix_(kept, mine)] = across
                matrix[np.ix_(mine, kept)] = across.T
                matrix[np.ix_(mine, mine)] = columns[part].T @ columns[part]
        return found


def folds_of(rows: Rows) -> Whole:
    """Return the stretch of time of each row. All stretches have the same number of windows, over all recordings."""
    count = rows.start.size
    return np.asarray(np.arange(count, dtype=np.int64) * FOLDS // max(count, 1))


def weighted(sums: Array, scatter: Array) -> Array:
    """Return the sum of all joints' products, weighted by the residuals' scatter; for each stretch, if present."""
    if sums.ndim == 4:
        sums = sums.sum(axis=0)
    return np.asarray(np.einsum("jab,j->ab", sums, 1.0 / scatter**2))


def powers(sums: Array, values: Array) -> Array:
    """Return the squared residuals of each joint (and stretch) for given values of the scaled parameters."""
    full = np.append(values, -1.0)
    return np.asarray(np.maximum(np.einsum("...ab,a,b->...", sums, full, full), 0.0))
