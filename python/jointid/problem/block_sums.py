"""Least squares without one block of windows in turn, for many shapes at a time, from sums of products."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.base.values import dataclass

Array = NDArray[np.float64]

# Share of a column's square: a coefficient that the training blocks do not determine stays near 0.
_RIDGE = 1e-13


@dataclass(frozen=True, slots=True, kw_only=True)
class Fitted:
    """Fits of one model at several shapes, with each block left out in turn.

    Attributes
    ----------
    training, missed : ndarray, shape (shapes, blocks)
        Sums of squared residuals of the fitted blocks, and of the held-out block.
    coefficients : ndarray, shape (shapes, blocks, p)
        Coefficients without each block.
    whole : ndarray, shape (shapes, p)
        Coefficients fitted to all blocks.
    penalty : ndarray, shape (shapes,)
        Sum of squared residuals of the fit to all blocks.
    """

    training: Array
    missed: Array
    coefficients: Array
    whole: Array
    penalty: Array


@dataclass(frozen=True, slots=True, kw_only=True)
class BlockSums:
    """Sums of products of columns over each block of windows.

    Attributes
    ----------
    products : ndarray, shape (blocks, columns, columns)
    """

    products: Array

    @classmethod
    def of(cls, matrix: Array, blocks: Sequence[NDArray[np.int64]], threads: int) -> BlockSums:
        """Return the sums of products of a matrix's columns, shape (windows, columns), over blocks of its rows."""
        products = []
        for rows in blocks:
            # Not matrix.T @ matrix: the last bits from BLAS depend on its number of threads.
            triangle = _core.triangle(np.asfortranarray(matrix[rows]), threads=threads)
            products.append(np.einsum("ki,kj->ij", triangle, triangle))
        return cls(products=np.array(products))

    def fitted(self, combined: Array) -> Fitted:
        """Fit a target by regressors without each block, and predict the left-out block.

        Parameters
        ----------
        combined : ndarray, shape (shapes, columns, p + 1)
            Linear combinations of the columns that give the p regressors and, last, the target.
        """
        turned = np.swapaxes(combined, 1, 2)[:, None]
        sums = turned @ self.products @ combined[:, None]
        total = sums.sum(axis=1)
        whole, penalty = _solved(total)
        coefficients, training = _solved(total[:, None] - sums)
        return Fitted(
            training=training,
            missed=_misfit(sums, coefficients),
            coefficients=coefficients,
            whole=whole,
            penalty=penalty,
        )


def _solved(sums: Array) -> tuple[Array, Array]:
    """Return coefficients and squared residual of the last column by the others, for a stack of sums of products."""
    count = sums.shape[-1] - 1
    square = sums[..., :count, :count]
    sizes = np.sqrt(np.maximum(np.einsum("...ii->...i", square), 0.0))
    sizes = np.where(sizes > 0.0, sizes, 1.0)
    scaled = square / (sizes[..., :, None] * sizes[..., None, :]) + _RIDGE * np.eye(count)
    wanted = sums[..., :count, count] / sizes
    found = np.linalg.solve(scaled, wanted[..., None])[..., 0] / sizes
    return found, _misfit(sums, found)


def _misfit(sums: Array, coefficients: Array) -> Array:
    """Return the sum of squared residuals at these coefficients; at least 0 despite rounding."""
    ones = np.ones((*coefficients.shape[:-1], 1))
    weights = np.concatenate([-coefficients, ones], axis=-1)
    return np.asarray(np.maximum(np.einsum("...i,...ij,...j->...", weights, sums, weights), 0.0))
