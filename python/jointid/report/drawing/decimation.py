"""Reduce long signals to few points that look the same. Peaks are kept."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Places = NDArray[np.int64]


def outline(columns: Places, values: NDArray[np.float64]) -> Places:
    """Choose the samples that preserve a line's look: first, lowest, highest and last of each column.

    Parameters
    ----------
    columns : ndarray of int, shape (n,)
        Column of the picture for each sample, in order: samples in the same column are adjacent.
    values : ndarray, shape (n,)
        Finite values.

    Returns
    -------
    ndarray of int
        Indices of the samples to keep, in order, at most four for each column.
    """
    if len(columns) == 0:
        return np.zeros(0, dtype=np.int64)
    starts = np.concatenate([[0], np.flatnonzero(np.diff(columns)) + 1])
    ends = np.append(starts[1:], len(columns))
    group = np.repeat(np.arange(len(starts)), ends - starts)
    kept = np.zeros(len(columns), dtype=bool)
    kept[starts] = True
    kept[ends - 1] = True
    for extreme in (np.minimum, np.maximum):
        reached = np.flatnonzero(values == extreme.reduceat(values, starts)[group])
        first = np.ones(len(reached), dtype=bool)
        first[1:] = np.diff(group[reached]) != 0
        kept[reached[first]] = True
    return np.flatnonzero(kept)


def distinct(across: Places, up: Places, cell: int) -> Places:
    """Return the index of one point in each occupied cell of a grid; other points there would be hidden."""
    width = int(up.max(initial=0)) // cell + 1
    _, index = np.unique((across // cell) * width + up // cell, return_index=True)
    return np.sort(index)
