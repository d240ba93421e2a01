"""Held-out parts: what is left out in turn, and which candidate the prediction of these parts prefers."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.base.errors import InputError

Array = NDArray[np.float64]

_FEWEST = 4  # windows of each joint that a block needs
_ONE_ERROR = 0.841345  # probability below one standard error of a normal distribution


def block_starts(start: Array, count: int, joints: int = 1) -> Array:
    """Return where all blocks but the first begin [s]: contiguous ones, of equally many windows.

    Parameters
    ----------
    start : ndarray, shape (windows,)
        Start of the windows of all joints, ascending [s].
    count : int
        Number of blocks.
    joints : int
        Default 1.

    Raises
    ------
    InputError
        Too few windows for so many blocks.
    """
    if start.size < count * _FEWEST * joints:
        joint, of_each = (f" of {joints} joints", " of each") if joints > 1 else ("", "")
        raise InputError(
            f"the recording has {start.size} windows{joint}, and each block needs at least {_FEWEST}{of_each}",
            argument="folds",
            value=count,
            remedy="use fewer folds, or shorter windows",
        )
    return start[[part[0] for part in np.array_split(np.arange(start.size), count)[1:]]]


def groups_of(recordings: int, count: int) -> list[NDArray[np.intp]]:
    """Return the recordings that are held out together: each alone, or in `count` groups if there are more."""
    return np.array_split(np.arange(recordings), min(count, recordings))


def preferred(
    scores: Sequence[float], parameters: Sequence[int], worse: Callable[[int, int], bool]
) -> tuple[int, int]:
    """Return the candidate with the smallest score, and the one with the fewest parameters that is not worse.

    `worse` tells whether a candidate, the first, predicts clearly worse than the best one.
    """
    every = range(len(scores))
    best = min(every, key=lambda each: scores[each])
    near = [each for each in every if each == best or not worse(each, best)]
    return best, min(near, key=lambda each: (parameters[each], scores[each]))


def one_error(parts: int) -> float:
    """Return how many standard errors over so many parts are one of a normal distribution: few know theirs badly."""
    return _core.student_quantile(_ONE_ERROR, max(1, parts - 1))


def in_errors(differences: Array) -> float:
    """Return the mean of differences over the parts in terms of its standard error."""
    mean, count = float(differences.mean()), differences.size
    error = float(differences.std(ddof=1)) / np.sqrt(count) if count > 1 else np.inf
    if error == 0.0:
        return float(np.sign(mean)) * (np.inf if mean else 0.0)
    return float(mean / error)
