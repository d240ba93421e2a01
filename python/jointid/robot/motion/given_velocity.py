"""A recorded velocity: its delay, its noise, and the motion that it gives by integration."""

from __future__ import annotations

import itertools

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.recording.recording import Recording

Array = NDArray[np.float64]

_SLOW = 0.3  # [s]: over longer times, positions are more accurate than a recorded velocity
_WHOLE = 3.0  # [s], longest time before a velocity's error drifts, to find its delay
_ROUNDS = 3
_SURE = 3.0  # standard errors of a delay
_CLUSTER = 0.3  # [s] of motion that counts as one observation
_LONGEST = 0.05  # [s]


def in_time(velocity: Array, derived: Recording) -> Array:
    """Return a recorded velocity on the positions' clock.

    The integral has the same delay: it differs from the position by the delay times the velocity.
    """
    time, delay = derived.time, 0.0
    cluster = np.unique((time // _CLUSTER).astype(np.int64), return_inverse=True)[1]
    for _ in range(_ROUNDS):
        moved = np.interp(time + delay, time, velocity)
        apart = derived.position - _travelled(moved, derived)
        apart, speed = (each - _mean(each, derived, _WHOLE) for each in (apart, moved))
        power = float(speed @ speed)
        if not power:
            return velocity
        step = float(speed @ apart) / power
        scores = np.bincount(cluster, speed * (apart - step * speed))
        error = float(np.sqrt(scores @ scores)) / power
        if abs(delay + step) > _LONGEST:
            return velocity
        delay += step
    if abs(delay) <= _SURE * error:
        return velocity
    return np.asarray(np.interp(time + delay, time, velocity))


def noise_of(velocity: Array, derived: Recording) -> Array:
    """Return the standard deviation of a recorded velocity's noise, the same at each sample."""
    after = [gap.index for gap in derived.gaps]
    noise = _core.position_noise(derived.time, velocity, after, derived.sample_period)
    return np.full(velocity.size, noise.sigma)


def integrated(velocity: Array, derived: Recording) -> Array:
    """Return the position: a recorded velocity integrated from sample to sample, near the recorded position over time.

    The mask and the travel between samples use it, because a coarse position stands still and jumps.
    """
    travelled = _travelled(velocity, derived)
    return np.asarray(travelled + _mean(derived.position - travelled, derived, _SLOW))


def _travelled(velocity: Array, derived: Recording) -> Array:
    """Return the velocity's integral; it has no meaning between stretches."""
    means = 0.5 * (velocity[1:] + velocity[:-1])
    return np.concatenate([[0.0], np.cumsum(means * np.diff(derived.time))])


def _mean(values: Array, derived: Recording, duration: float) -> Array:
    """Return moving averages of each stretch without a gap; they are shorter at its ends."""
    found = np.empty_like(values)
    half = max(1, round(0.5 * duration / derived.sample_period))
    edges = [0, *(gap.index + 1 for gap in derived.gaps), values.size]
    for first, end in itertools.pairwise(edges):
        sums = np.concatenate([[0.0], np.cumsum(values[first:end])])
        place = np.arange(end - first)
        reach = np.minimum(half, np.minimum(place, end - first - 1 - place))
        found[first:end] = (sums[place + reach + 1] - sums[place - reach]) / (2 * reach + 1)
    return found
