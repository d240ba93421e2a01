"""The rows of all joints as products of their columns: what every solution needs, however long the recording is.

Rows are looked at once. Least squares with any weights of the joints, any columns left out and any stretch of time held
out then costs the same. The columns are scaled to unit length, so that little is lost by squaring the condition.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Self

import numpy as np
from numpy.typing import NDArray

from jointid.robot.balance.balance import Rows

Array = NDArray[np.float64]
Whole = NDArray[np.int64]

FOLDS = 8  # stretches of time, held out in turn


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Products:
    """Columns and target of all joints."""

    blocks: tuple[Array, ...]  # scaled columns of each joint's rows, the target last
    places: tuple[Whole, ...]  # numbers of each joint's rows
    folds: tuple[Whole, ...]  # stretch of time of each of them
    norms: Array  # lengths of the columns and of the target, by which they are divided
    sums: Array  # (FOLDS, joints, columns + 1, columns + 1), products by stretch and joint

    @classmethod
    def of(cls, blocks: list[Array], places: list[Whole], rows: Rows) -> Self:
        """Return the products of unscaled blocks, which are scaled in place."""
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
        """How many columns there are besides the target."""
        return self.norms.size - 1

    @property
    def counts(self) -> Whole:
        """Rows of each joint."""
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
    """Return the stretch of time of each row: as many windows in each, through all recordings."""
    count = rows.start.size
    return np.asarray(np.arange(count, dtype=np.int64) * FOLDS // max(count, 1))


def weighted(sums: Array, scatter: Array) -> Array:
    """Return products of all joints, each weighted by the scatter of its residuals; over stretches if there are any."""
    if sums.ndim == 4:
        sums = sums.sum(axis=0)
    return np.asarray(np.einsum("jab,j->ab", sums, 1.0 / scatter**2))


def powers(sums: Array, values: Array) -> Array:
    """Return the squared residuals of each joint (and stretch) with some values of the scaled parameters."""
    full = np.append(values, -1.0)
    return np.asarray(np.maximum(np.einsum("...ab,a,b->...", sums, full, full), 0.0))
