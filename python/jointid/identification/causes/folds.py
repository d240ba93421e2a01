"""Out-of-sample misfit of the model with some further columns, over blocks of time, at several scales."""

from __future__ import annotations

import functools
import itertools

import numpy as np
from numpy.typing import NDArray

from jointid.base.values import dataclass
from jointid.recording.order_statistics import distinct

Array = NDArray[np.float64]

BLOCKS = 20
_FEWEST = 4  # sums of windows a block
_RIDGE = 1e-9  # of columns of unit size


def summed(values: Array, run: NDArray[np.int64], factor: int) -> tuple[Array, NDArray[np.int64]]:
    """Return sums over `factor` neighbouring windows of one recording, and their recordings."""
    if factor == 1:
        return values, run
    first = first_windows(run, factor)
    return np.add.reduceat(values, first, axis=0), run[first]


def first_windows(run: NDArray[np.int64], factor: int) -> NDArray[np.int64]:
    """Return the first of every `factor` neighbouring windows of one recording."""
    if factor == 1:
        return np.arange(len(run))
    edges = np.searchsorted(run, [*distinct(run), run[-1] + 1])
    return np.concatenate([np.arange(low, high, factor) for low, high in itertools.pairwise(edges)])


@dataclass(frozen=True, eq=False)
class Folds:
    """Inner products of all columns in each block of time.

    Attributes
    ----------
    products : ndarray, shape (blocks, columns, columns)
        The last column is the residual.
    """

    products: Array

    @classmethod
    def of(cls, columns: Array, residual: Array) -> Folds | None:
        """Cut the rows into blocks; None with too few of them."""
        rows = len(residual)
        blocks = min(BLOCKS, rows // _FEWEST)
        if blocks < 5:
            return None
        both = np.column_stack([columns, residual])
        size = np.sqrt(np.einsum("ij,ij->j", both, both))
        both = both / np.where(size > 0.0, size, 1.0)
        edges = np.linspace(0, rows, blocks + 1).astype(int)
        products = [
            np.einsum("ni,nj->ij", both[low:high], both[low:high])
            for low, high in itertools.pairwise(edges)
        ]
        return cls(np.array(products))

    @functools.cached_property
    def _others(self) -> Array:
        """The products of all other blocks, for each block."""
        return np.asarray(self.products.sum(axis=0) - self.products)

    @functools.cached_property
    def _known(self) -> dict[tuple[int, ...], Array]:
        """Misfits that were asked for: what is fitted anyway is compared with many candidates."""
        return {}

    def misfit(self, columns: list[int]) -> Array:
        """Sum of squares of the residual in each block, with these columns fitted to the other blocks."""
        asked = tuple(columns)
        if asked not in self._known:
            self._known[asked] = self._misfit(columns)
        return self._known[asked]

    def _misfit(self, columns: list[int]) -> Array:
        every = self.products
        own = every[:, -1, -1].copy()
        if not columns:
            return own
        train = self._others
        square = np.ix_(range(len(every)), columns, columns)
        matrix = train[square] + _RIDGE * np.eye(len(columns))
        found = np.linalg.solve(matrix, train[:, columns, -1][..., None])[..., 0]
        own -= 2.0 * np.einsum("bi,bi->b", found, every[:, columns, -1])
        own += np.einsum("bi,bij,bj->b", found, every[square], found)
        return np.asarray(np.maximum(own, 0.0))
