"""Held-out residual of the model with further columns, over blocks of time, at several scales."""

from __future__ import annotations

import functools
import itertools

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.base.values import dataclass
from jointid.recording.order_statistics import distinct

Array = NDArray[np.float64]

BLOCKS = 20
_FEWEST = 4  # smallest number of rows per block


def summed(values: Array, run: NDArray[np.int64], factor: int) -> tuple[Array, NDArray[np.int64]]:
    """Return sums over `factor` neighboring windows of one recording, and the recording of each sum."""
    if factor == 1:
        return values, run
    first = first_windows(run, factor)
    return np.add.reduceat(values, first, axis=0), run[first]


def first_windows(run: NDArray[np.int64], factor: int) -> NDArray[np.int64]:
    """Return the first of every `factor` neighboring windows of one recording."""
    if factor == 1 or run[0] == run[-1]:
        return np.arange(0, len(run), factor)
    edges = np.searchsorted(run, [*distinct(run), run[-1] + 1])
    return np.concatenate([np.arange(low, high, factor) for low, high in itertools.pairwise(edges)])


@dataclass(frozen=True, eq=False)
class Folds:
    """Inner products of all columns in each block of time.

    Attributes
    ----------
    blocks : Folds
        Folds of the core; the last column is the residual.
    """

    blocks: _core.Folds

    @classmethod
    def of(cls, columns: Array, residual: Array) -> Folds | None:
        """Return the rows in blocks; None if there are too few rows."""
        return cls.of_rows(np.column_stack([columns, residual]))

    @classmethod
    def of_rows(cls, rows: Array) -> Folds | None:
        """Return rows in blocks, as `of`; the last column is the residual."""
        blocks = min(BLOCKS, len(rows) // _FEWEST)
        if blocks < 5:
            return None
        return cls(_core.Folds(rows, np.linspace(0, len(rows), blocks + 1).astype(int).tolist()))

    @functools.cached_property
    def _known(self) -> dict[tuple[int, ...], Array]:
        """Cache of `misfit`, because the same base columns are compared with many candidates."""
        return {}

    @functools.cached_property
    def _totals(self) -> dict[tuple[int, ...], float]:
        """Cache of `total`."""
        return {}

    def total(self, columns: list[int]) -> float:
        """Return the sum of `misfit` over all blocks."""
        asked = tuple(columns)
        if asked not in self._totals:
            self._totals[asked] = float(self.misfit(columns).sum())
        return self._totals[asked]

    def misfit(self, columns: list[int]) -> Array:
        """Return the sum of squared residuals in each block, with these columns fitted to the other blocks."""
        asked = tuple(columns)
        if asked not in self._known:
            self._known[asked] = np.asarray(self.blocks.misfit(columns))
        return self._known[asked]
