"""Least squares without negative entries from normal equations, many at once."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from jointid import _core

Array = NDArray[np.float64]

_WEAKEST = 1e-14  # eigenvalue of the scaled equations
_SLACK = 1e-10  # of a gradient, relative to the right side's
_ROUNDS = 8


def not_negative(normal: Array, right: Array) -> Array:
    """Return the solutions without negative entries, shape (m, p), of `normal` (m, p, p) and `right` (m, p).

    Block principal pivoting: solve with all entries, put the negative ones on zero, take back those whose gradient says
    so, and so on. It may go round in circles; what is not done after some rounds, the core's solver does.
    """
    count, size = right.shape
    scale = np.sqrt(np.maximum(np.einsum("mii->mi", normal), 1e-300))
    matrices = normal / (scale[:, :, None] * scale[:, None, :])
    sides = right / scale
    unit = np.eye(size)
    limit = _SLACK * np.abs(sides).max(axis=1, keepdims=True, initial=0.0)
    inside = np.ones((count, size), dtype=bool)
    found = np.zeros((count, size))
    left = np.arange(count)
    for _ in range(_ROUNDS):
        mask = inside[left]
        own = matrices[left]
        both = mask[:, :, None] & mask[:, None, :]
        part = np.where(both, own, 0.0) + unit * np.where(mask, _WEAKEST, 1.0)[:, None, :]
        values = np.linalg.solve(part, (sides[left] * mask)[:, :, None])[:, :, 0]
        slope = sides[left] - (own @ values[:, :, None])[:, :, 0]
        wrong = np.where(mask, values < 0.0, slope > limit[left])
        found[left] = values
        inside[left] ^= wrong
        left = left[wrong.any(axis=1)]
        if len(left) == 0:
            break
    for k in left:
        found[k] = _by_core(matrices[k], sides[k])
    return np.asarray(found / scale + 0.0)  # no -0


def _by_core(matrix: Array, side: Array) -> Array:
    values, vectors = np.linalg.eigh(matrix)
    root = np.sqrt(np.maximum(values, _WEAKEST))
    found, _ = _core.non_negative_least_squares(root[:, None] * vectors.T, vectors.T @ side / root)
    return np.asarray(found)
