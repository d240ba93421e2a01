"""What it does to the parameters when signals are measured once more."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.base.errors import InputError
from jointid.base.values import dataclass
from jointid.problem.problem import Problem
from jointid.recording.recording import Recording

Array = NDArray[np.float64]

Shifts = tuple[Array | None, Array | None]

DRAWS = 4  # two pairs
_FACTORS = (0.5, 2.0)  # of the windows' duration, as of `Shifts`


@dataclass(frozen=True, slots=True, kw_only=True)
class NoiseEffect:
    """Change of the parameters when signals become as noisy again.

    Attributes
    ----------
    shifts : ndarray, shape (2, p)
        Its mean over each of two pairs of opposite draws: a systematic part of about this size is in the estimate.
    spread : ndarray, shape (p,)
        Standard deviation over the draws.
    of_windows : ndarray, shape (p,)
        Root mean square of what it adds to the shift to halved and to doubled windows.
    chance : ndarray, shape (p,)
        Variance of what the shifts have in common and is chance. Default 0: nothing.
    """

    shifts: Array
    spread: Array
    of_windows: Array
    chance: Array | float = 0.0

    @property
    def systematic(self) -> Array:
        """Size of the shift without what chance adds to it.

        The square of a mean contains the variance of the mean; the product of two independent ones does not.
        """
        first, second = self.shifts
        return np.asarray(np.sqrt(np.maximum(0.0, first * second - self.chance)))

    @property
    def size(self) -> Array:
        """Root of the sum of the squares of the systematic shift and of the spread."""
        return np.asarray(np.hypot(self.systematic, self.spread))


def noise_effect(
    problem: Problem,
    penalty: _core.Penalty,
    best: Array,
    bounds: tuple[Array, Array],
    again: Callable[[Recording, int, int], Recording],
    shifts: Shifts,
) -> NoiseEffect | None:
    """Return how the parameters move over the same windows (simulation and extrapolation, Cook and Stefanski 1994).

    Parameters
    ----------
    problem : Problem
    penalty : Penalty
        Over the windows used.
    best : ndarray, shape (p,)
        The parameters found.
    bounds : tuple of ndarray
        Their lower and upper bounds.
    again : callable
        Returns a recording with more noise, from itself, the number of the draw and its own number. An odd draw
        has the noise of the one before with the other sign: in the mean of both, what is linear in the noise, and
        so of chance, is gone.
    shifts : tuple of ndarray or None
        Change of each parameter when the windows are halved and doubled; None is not asked for.

    Notes
    -----
    Shorter windows have more of the velocity's noise, and other ones have other noise: a part of the shifts that
    decreases with the recording's length, and that the standard errors contain.
    """
    moved, added = [], []
    for draw in range(DRAWS):
        runs = tuple(again(run, draw, number) for number, run in enumerate(problem.recordings))
        other = dataclasses.replace(problem, recordings=runs)
        found = _refitted(other, penalty, best, bounds)
        if found is None:  # with this noise the joint seems to stand still
            return None
        moved.append(found - best)
        for factor, shift in zip(_FACTORS, shifts, strict=True):
            there = None if shift is None else _refitted(other, penalty, best, bounds, factor)
            if shift is not None and there is not None:
                added.append(there - found - shift)
    draws = np.array(moved)
    return NoiseEffect(
        shifts=0.5 * (draws[0::2] + draws[1::2]),
        spread=np.std(draws, axis=0),
        of_windows=np.sqrt(np.mean(np.square(added), axis=0)) if added else np.zeros(len(best)),
    )


def _refitted(
    problem: Problem,
    penalty: _core.Penalty,
    best: Array,
    bounds: tuple[Array, Array],
    factor: float = 1.0,
) -> Array | None:
    """The parameters over windows that are so many times as long, or None where there is no fit."""
    options = _core.WindowOptions(
        duration=factor * penalty.window_duration, cumulative=bool(penalty.cumulative)
    )
    try:
        return problem.parts(options).refit(*bounds, best, threads=problem.threads)
    except InputError:
        return None
