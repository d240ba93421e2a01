"""Effect of the noise of extra signals on each parameter, by adding the same amount of noise again."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.base.values import dataclass
from jointid.identification.inference.added_noise import NoiseEffect, Shifts, noise_effect
from jointid.identification.inference.velocity_noise import measured_again
from jointid.joint.own_terms import OwnTerms
from jointid.problem.problem import Problem
from jointid.recording.derived import derived_velocity
from jointid.recording.extra_noise import extra_measured_again, noise_of_extra
from jointid.recording.recording import Recording

Array = NDArray[np.float64]

_HARMLESS = 3e-3  # harmless noise, as a share of the signal's standard deviation


@dataclass(frozen=True, slots=True, kw_only=True)
class OwnNoise:
    """Noise of extra signals, and its effect.

    Attributes
    ----------
    effect : NoiseEffect
        Change of the parameters when the same amount of noise is added to all these signals again.
    noise : tuple of (str, float)
        Each signal with the standard deviation of its noise, in the signal's unit.
    """

    effect: NoiseEffect
    noise: tuple[tuple[str, float], ...]


def own_systematic(
    problem: Problem,
    penalty: _core.Penalty,
    best: Array,
    lower: Array,
    upper: Array,
    shifts: Shifts,
) -> OwnNoise | None:
    """Return the effect of the extra signals' noise; None if it is harmless or no coefficient is free.

    Noise in a signal makes the coefficient of its term too small (attenuation) and changes correlated parameters.
    A known torque or inertia with a fixed gain has no such effect, because its noise is noise of the torque.

    Parameters
    ----------
    problem : Problem
    penalty : Penalty
        Penalty over the windows of the fit.
    best, lower, upper : ndarray, shape (p,)
        Estimated parameters and their bounds.
    shifts : tuple of ndarray or None
        Change of each parameter when the windows are halved and doubled; None is skipped.
    """
    own = problem.choice.model.resolved.terms
    if not own.each:
        return None
    free = {
        name.partition("[")[0]
        for name, low, high in zip(penalty.names, lower, upper, strict=True)
        if high > low
    }
    noisy = _noisy(problem, own, free)
    if not noisy:
        return None
    effect = noise_effect(
        problem,
        penalty,
        best,
        (lower, upper),
        lambda run, draw, number: extra_measured_again(run, list(noisy), draw, number),
        shifts,
    )
    return None if effect is None else OwnNoise(effect=effect, noise=tuple(noisy.items()))


def measured_once_more(problem: Problem) -> Problem:
    """Return the problem with the noise of velocity and own terms' signals added again, including harmless noise."""
    signals = problem.choice.model.resolved.terms.signals
    runs = tuple(
        extra_measured_again(measured_again(run, 0, number), signals, 0, number)
        for number, run in enumerate(problem.recordings)
    )
    return replace(problem, recordings=runs)


def _noisy(problem: Problem, own: OwnTerms, free: set[str]) -> dict[str, float]:
    """Return the signals with relevant noise, each with its largest noise over the recordings."""
    noisy: dict[str, float] = {}
    for each in own.each:
        if each.signal not in own.signals or not free & set(each.keys):
            continue
        for run in problem.recordings:
            sigma = noise_of_extra(run, each.signal)
            if _matters(run, each.signal, each.rate, sigma):
                noisy[each.signal] = max(sigma, noisy.get(each.signal, 0.0))
    return noisy


def _matters(run: Recording, signal: str, rate: bool, sigma: float) -> bool:
    values = run.extra[signal]
    if not sigma > 0.0:
        return False
    if rate:
        return derived_velocity(run.time, values, run.gaps, run.sample_period).refined
    return sigma > _HARMLESS * float(np.std(values))
