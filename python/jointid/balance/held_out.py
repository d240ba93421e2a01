"""Held-out data: the parts that are left out in turn, and the choice of a candidate by their prediction."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.base.errors import InputError

Array = NDArray[np.float64]

_FEWEST = 4  # windows per joint that a block needs
_ONE_ERROR = 0.841345  # probability of a normal variable below one standard error


def block_starts(start: Array, count: int, joints: int = 1) -> Array:
    """Return the start times of all blocks except the first [s]; blocks are contiguous and have equally many windows.

    Parameters
    ----------
    start : ndarray, shape (windows,)
        Start of the windows of all joints, ascending [s].
    count : int
        Number of blocks.
    joints : int
        Number of joints. Default 1.

    Raises
    ------
    InputError
        There are too few windows for this number of blocks.
    """
    if start.size < count * _FEWEST * joints:
        joint, of_each = (f" of {joints} joints", " of each joint") if joints > 1 else ("", "")
        raise InputError(
            f"the recording has {start.size} windows{joint}, but each block needs at least {_FEWEST}{of_each}",
            argument="folds",
            value=count,
            remedy="use fewer folds, or shorter windows",
        )
    return start[[part[0] for part in np.array_split(np.arange(start.size), count)[1:]]]


def groups_of(recordings: int, count: int) -> list[NDArray[np.intp]]:
    """Return the groups of recordings that are held out together: each alone, or `count` groups if there are more."""
    return np.array_split(np.arange(recordings), min(count, recordings))


def preferred(
    scores: Sequence[float], parameters: Sequence[int], worse: Callable[[int, int], bool]
) -> tuple[int, int]:
    """Return the candidate with the smallest score, and the simplest candidate that is not clearly worse.

    `worse(candidate, best)` returns whether a candidate predicts clearly worse than the best one.
    """
    every = range(len(scores))
    best = min(every, key=lambda each: scores[each])
    near = [each for each in every if each == best or not worse(each, best)]
    return best, min(near, key=lambda each: (parameters[each], scores[each]))


def one_error(parts: int) -> float:
    """Return the multiple of a standard error from this number of parts that matches one normal standard error."""
    return _core.student_quantile(_ONE_ERROR, max(1, parts - 1))


def in_errors(differences: Array) -> float:
    """Return the mean of differences over the parts, in units of its standard error."""
    mean, count = float(differences.mean()), differences.size
    error = float(differences.std(ddof=1)) / np.sqrt(count) if count > 1 else np.inf
    if error == 0.0:
        return float(np.sign(mean)) * (np.inf if mean else 0.0)
    return float(mean / error)
