"""What it does to the parameters when signals are measured once more."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.base.errors import InputError
from jointid.problem.problem import Problem
from jointid.recording.recording import Recording

Array = NDArray[np.float64]

REPEATS = 4


@dataclass(frozen=True, slots=True, kw_only=True)
class NoiseEffect:
    """Change of the parameters when signals become as noisy again.

    Attributes
    ----------
    shift : ndarray, shape (p,)
        Its median over some draws: a systematic part of about this size is in the estimate.
    spread : ndarray, shape (p,)
        Standard deviation over the draws.
    draws : int
    """

    shift: Array
    spread: Array
    draws: int

    @property
    def systematic(self) -> Array:
        """Size of the shift without what chance adds to it."""
        chance = np.square(self.spread) / self.draws
        return np.asarray(np.sqrt(np.maximum(0.0, np.square(self.shift) - chance)))

    @property
    def size(self) -> Array:
        """Root of the sum of both squares."""
        return np.asarray(np.hypot(self.shift, self.spread))


def noise_effect(
    problem: Problem,
    penalty: _core.Penalty,
    best: Array,
    bounds: tuple[Array, Array],
    again: Callable[[Recording, int, int], Recording],
    repeats: int = REPEATS,
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
        Returns a recording with more noise, from itself, the number of the draw and its own number.
    repeats : int
        Draws. Default 4.
    """
    options = _core.WindowOptions(
        duration=penalty.window_duration, cumulative=bool(penalty.cumulative)
    )
    moved = []
    for draw in range(repeats):
        runs = tuple(again(run, draw, number) for number, run in enumerate(problem.recordings))
        other = dataclasses.replace(problem, recordings=runs)
        try:
            found = other.parts(options).refit(*bounds, best, threads=problem.threads)
        except InputError:  # with this noise the joint seems to stand still
            continue
        moved.append(found - best)
    if len(moved) < 2:
        return None
    return NoiseEffect(
        shift=np.median(moved, axis=0),
        spread=np.std(moved, axis=0, ddof=1),
        draws=len(moved),
    )
