"""Unwrapping of angles that start again after a turn, based on the motion around each wrap."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from jointid.recording.order_statistics import median
from jointid.recording.recording import Recording
from jointid.recording.signals import FloatArray

_TURN = 2.0 * math.pi
_NEAR = 6  # steps on either side that show the joint's motion there
_AWAY = 3.0  # times these steps: largest step that may remain after unwrapping
_SLACK = 0.02  # of a turn
_ALIKE = 0.03  # tolerance of the size, relative to another wrap
_MANY = 3  # wraps needed to show a size other than a turn


def unwrapped(run: Recording) -> tuple[FloatArray, int, float] | None:
    """Return the position without wraps, the number of wraps, and their size; None if there is no wrap.

    A wrap is a jump of one turn that contradicts the velocity or the steps around it. Jumps of another size are
    wraps if several have the same size, and this size equals the range of the position.
    """
    if run.kind != "revolute":
        return None
    position, steps = run.position, np.diff(run.position)
    least = _least(position, steps)
    between = _between(steps, least)
    if len(between):
        position = position.copy()
        position[between] = position[between - 1]
        steps = np.diff(position)
    large = np.flatnonzero(np.abs(steps) > least)
    if not len(large):
        return None
    near = _near(steps, large)
    around = np.abs(near).max(axis=1)
    expected, slack = near.mean(axis=1), _AWAY * around
    if not run.velocity_derived:
        period = np.diff(run.time)[large]
        expected = 0.5 * (run.velocity[large] + run.velocity[large + 1]) * period
        slack = np.minimum(slack, 0.5 * np.abs(expected)) + around
    size = _size(position, steps[large] - expected)
    turns = np.round((steps[large] - expected) / size)
    left = np.abs(steps[large] - expected - turns * size)
    wraps = (turns != 0.0) & (left <= slack + _SLACK * size) & (around < 0.5 * size)
    if not wraps.any():
        return None
    correction = np.zeros(len(run))
    correction[large[wraps] + 1] = turns[wraps] * size
    position = position - np.cumsum(correction)
    position[between] = 0.5 * (position[between - 1] + position[between + 1])
    return position, int(np.count_nonzero(wraps)), size


def _least(position: FloatArray, steps: FloatArray) -> float:
    """Return the smallest size of a wrap: half of the range, or of a turn."""
    return 0.5 * min(_TURN, float(np.ptp(position))) if len(steps) else math.inf


def _between(steps: FloatArray, least: float) -> NDArray[np.intp]:
    """Return the rows inside a jump of two steps: angles that were interpolated over a wrap."""
    rows = np.flatnonzero(np.abs(steps[1:] + steps[:-1]) > least)
    rows = rows[(rows > 0) & (rows < len(steps) - 2)]
    size, beside = np.abs(steps), np.maximum(np.abs(steps[rows - 1]), np.abs(steps[rows + 2]))
    smaller = np.minimum(size[rows], size[rows + 1])
    return rows[(steps[rows] * steps[rows + 1] > 0.0) & (smaller > _AWAY * beside)] + 1


def _near(steps: FloatArray, large: NDArray[np.intp]) -> FloatArray:
    """Return the steps near each large step; neighbours that are large themselves count as zero."""
    small = steps.copy()
    small[large] = 0.0
    reach = np.concatenate([np.arange(-_NEAR, 0), np.arange(1, _NEAR + 1)])
    return np.asarray(small[np.clip(large[:, None] + reach, 0, len(steps) - 1)])


def _size(position: FloatArray, jumps: FloatArray) -> float:
    """Return the size of the wraps: a turn, or the position's range if several jumps have this size."""
    usual = median(np.abs(jumps))
    alike = np.abs(np.abs(jumps) / usual - 1.0) < _ALIKE
    whole = float(np.ptp(position))
    if len(jumps) >= _MANY and alike.all() and abs(usual / whole - 1.0) < _ALIKE:
        near_turn = abs(usual / _TURN - 1.0) < _ALIKE
        return _TURN if near_turn else usual
    return _TURN
