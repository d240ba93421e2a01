"""Effect of the velocity's noise on each parameter, by adding the same amount of noise again."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.balance.segments import Segments
from jointid.base.values import dataclass
from jointid.identification.inference.added_noise import (
    DRAWS,
    NoiseEffect,
    Shifts,
    noise_effect,
)
from jointid.identification.inference.random_shift import variance_over_segments
from jointid.problem.problem import Problem
from jointid.recording.extra_noise import noise_unit
from jointid.recording.recording import Recording
from jointid.recording.velocity_noise import follows_position, noise_of_velocity

Array = NDArray[np.float64]

_HARMLESS = 3e-4  # harmless noise as a share of the peak speed, as for a derived velocity
_SHARE = 1e-3  # share of noise in the variance of the velocity's change that the windows allow


@dataclass(frozen=True, slots=True, kw_only=True)
class VelocityEffect(NoiseEffect):
    """Change of the parameters when the same noise is added to the velocity again, because friction is nonlinear.

    Attributes
    ----------
    noise : float
        Standard deviation of the added velocity noise: median over the samples of the noisiest recording
        [rad/s or m/s].
    """

    noise: float


def velocity_systematic(
    problem: Problem,
    penalty: _core.Penalty,
    best: Array,
    lower: Array,
    upper: Array,
    shifts: Shifts,
    free: Sequence[int],
    segments: Segments,
) -> VelocityEffect | None:
    """Return the effect of the velocity's noise; None if the noise is harmless.

    A derived velocity is derived again, so that the test includes its smoothing. It is derived from the smooth
    position, rounded again to encoder counts. If the position has no counts, the same amount of noise is added to the
    position. A recorded velocity gets noise of its own size. The parameters are then fitted again.

    Parameters
    ----------
    problem : Problem
    penalty : Penalty
        Penalty over the windows of the fit.
    best, lower, upper : ndarray, shape (p,)
        Estimated parameters and their bounds.
    shifts : tuple of ndarray or None
        Change of each parameter when the windows are halved and doubled; None is skipped.
    free : sequence of int
        Indices of the free parameters that are not on a bound.
    segments : Segments
        Segments of the motion.
    """
    noisy = [is_noisy(run, penalty.noise_share) for run in problem.recordings]
    if not any(noisy):
        return None
    draws = [
        [measured_again(run, draw, number) if noisy[number] else run for draw in range(DRAWS)]
        for number, run in enumerate(problem.recordings)
    ]
    effect = noise_effect(
        problem,
        penalty,
        best,
        (lower, upper),
        lambda _, draw, number: draws[number][draw],
        shifts,
    )
    if effect is None:
        return None
    return VelocityEffect(
        shifts=effect.shifts,
        spread=effect.spread,
        of_windows=effect.of_windows,
        chance=variance_over_segments(
            problem, _in_the_mean(problem, draws), penalty, best, free, segments
        ),
        noise=max(
            noise_of_velocity(run)
            for run, too in zip(problem.recordings, noisy, strict=True)
            if too
        ),
    )


def _in_the_mean(problem: Problem, draws: Sequence[Sequence[Recording]]) -> Problem:
    """Return the problem with the mean velocity of the draws, which is smoothed again and has little added noise."""
    runs = tuple(
        run.with_velocity(np.mean([each.velocity for each in again], axis=0))
        for run, again in zip(problem.recordings, draws, strict=True)
    )
    return replace(problem, recordings=runs)


def is_noisy(run: Recording, share: float) -> bool:
    """Return whether a velocity's noise may matter; `share` is its share in the velocity's change over a window."""
    if follows_position(run):
        return run.derived.refined
    peak = float(np.abs(run.velocity).max())
    return share > _SHARE and noise_of_velocity(run) > _HARMLESS * peak


def measured_again(run: Recording, draw: int, number: int) -> Recording:
    """Return a recording with velocity noise added again. An odd draw is opposite to the previous one."""
    random = np.random.default_rng((draw // 2, number))
    unit = noise_unit(random, len(run), draw)
    if not follows_position(run):
        return run.with_velocity(run.velocity + noise_of_velocity(run) * unit)
    noise = run.derived.position_noise
    step = noise.quantum
    if not step > 0.0:
        scale = np.hypot(noise.sigma, noise.timing * run.velocity)
        position = run.position + scale * unit
    else:
        # At low speed the position stays within one count for many samples, unlike white noise. Therefore the smooth
        # position is rounded again, with shifted counts.
        others = np.sqrt(max(0.0, noise.sigma**2 - step**2 / 12.0))
        scale = np.hypot(others, noise.timing * run.velocity)
        place = random.random() + 0.5 * (draw % 2)  # the pair's rounding errors are nearly opposite
        position = (np.floor((_smooth(run) + scale * unit) / step + place) - place + 0.5) * step
    moved = Recording(time=run.time, position=position, kind=run.kind)
    return run.with_velocity(moved.velocity)


def _smooth(run: Recording) -> Array:
    """Return the integral of the velocity as a smooth position; over a gap it uses the recorded position change."""
    step = 0.5 * (run.velocity[1:] + run.velocity[:-1]) * np.diff(run.time)
    for gap in run.gaps:
        step[gap.index] = run.position[gap.index + 1] - run.position[gap.index]
    return np.asarray(run.position[0] + np.concatenate([[0.0], np.cumsum(step)]))
