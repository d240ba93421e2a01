"""Effect of noise in signals on the parameters, by adding the same amount of noise again."""

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
_FACTORS = (0.5, 2.0)  # factors on the windows' duration, as in `Shifts`


@dataclass(frozen=True, slots=True, kw_only=True)
class NoiseEffect:
    """Change of the parameters when the same amount of noise is added to signals again.

    Attributes
    ----------
    shifts : ndarray, shape (2, p)
        Mean change over each of two pairs of opposite draws. The estimate has a systematic error of about this size.
    spread : ndarray, shape (p,)
        Standard deviation of the change over the draws.
    of_windows : ndarray, shape (p,)
        Root mean square change of the shifts to halved and to doubled windows.
    chance : ndarray, shape (p,)
        Variance of the random part that both shifts have in common. Default 0.
    """

    shifts: Array
    spread: Array
    of_windows: Array
    chance: Array | float = 0.0

    @property
    def systematic(self) -> Array:
        """Size of the shift without its random part.

        The square of a mean contains the variance of the mean. The product of two independent means does not.
        """
        first, second = self.shifts
        return np.asarray(np.sqrt(np.maximum(0.0, first * second - self.chance)))

    @property
    def size(self) -> Array:
        """Root of the sum of squares of systematic shift and spread."""
        return np.asarray(np.hypot(self.systematic, self.spread))


def noise_effect(
    problem: Problem,
    penalty: _core.Penalty,
    best: Array,
    bounds: tuple[Array, Array],
    again: Callable[[Recording, int, int], Recording],
    shifts: Shifts,
) -> NoiseEffect | None:
    """Return the change of the parameters with more noise, over the same windows.

    The method is simulation extrapolation (Cook and Stefanski 1994). The result is None if no fit is possible.

    Parameters
    ----------
    problem : Problem
    penalty : Penalty
        Penalty over the windows of the fit.
    best : ndarray, shape (p,)
        Estimated parameters.
    bounds : tuple of ndarray
        Lower and upper bounds of the parameters.
    again : callable
        Function that returns a recording with more noise. Its arguments are the recording, the index of the draw and
        the index of the recording. An odd draw has the noise of the previous draw with the opposite sign, so the
        mean of both has no part that is linear in the noise, which is random.
    shifts : tuple of ndarray or None
        Change of each parameter when the windows are halved and doubled; None is skipped.

    Notes
    -----
    Shorter windows contain more noise of the velocity, and other windows contain other noise. This part of the
    shifts decreases with the length of the recording, and the standard errors contain it.
    """
    moved, added = [], []
    for draw in range(DRAWS):
        runs = tuple(again(run, draw, number) for number, run in enumerate(problem.recordings))
        other = dataclasses.replace(problem, recordings=runs)
        found = _refitted(other, penalty, best, bounds)
        if found is None:  # with the added noise, the joint seems to stand still
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
    """Return the parameters over windows that are longer by `factor`; None if there is no fit."""
    options = _core.WindowOptions(
        duration=factor * penalty.window_duration, cumulative=bool(penalty.cumulative)
    )
    try:
        return problem.parts(options).refit(*bounds, best, threads=problem.threads)
    except InputError:
        return None
