"""Errors in simulated recordings, caused by the motion, the controller, the noise and the identification."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from jointid.base.errors import InputError
from jointid.excitation.judging import Situation
from jointid.identification.prepared import Prepared, prepare
from jointid.problem.constant_torque import balanced
from jointid.simulation.batch import simulate_batch
from jointid.simulation.trajectory import Trajectory

Array = NDArray[np.float64]

_TOGETHER = 16  # recordings that are simulated together
_APART = 0.005  # relative spread of the joints' values


@dataclass(frozen=True, slots=True, kw_only=True)
class Rehearsal:
    """Errors of identifications from simulated recordings of one motion."""

    names: tuple[str, ...]
    errors: Array  # identified minus true value, shape (recordings, p)

    def rms(self) -> dict[str, float]:
        """Return the root mean square of each parameter's error."""
        size = np.sqrt(np.mean(self.errors**2, axis=0))
        return dict(zip(self.names, size.tolist(), strict=True))

    def bias(self) -> dict[str, float]:
        """Return the magnitude of each parameter's mean error minus the part that scatter explains; at least 0."""
        count = len(self.errors)
        scatter = np.var(self.errors, axis=0) / max(1, count - 1)
        size = np.sqrt(np.maximum(np.mean(self.errors, axis=0) ** 2 - scatter, 0.0))
        return dict(zip(self.names, size.tolist(), strict=True))


def rehearse(
    situation: Situation,
    trajectory: Trajectory,
    values: Mapping[str, float],
    count: int,
    *,
    first: int = 0,
    threads: int = 0,
    observe: Callable[[int], object] | None = None,
) -> Rehearsal:
    """Simulate `count` recordings of joints near these values, and identify each.

    `first` is the seed of the first recording's noise. `observe` is called with the number of finished recordings.
    """
    names = situation.request.names
    errors = np.empty((count, len(names)))
    for begin in range(0, count, _TOGETHER):
        seeds = list(range(first + begin, first + min(begin + _TOGETHER, count)))
        drawn = [_nearby(values, seed) for seed in seeds]
        batch = simulate_batch(
            [situation.with_values(each) for each in drawn],
            situation.controller,
            trajectory,
            control_period=situation.control_period,
            sensors=situation.sensors,
            seeds=seeds,
            recordings=True,
            threads=threads,
        )
        for place, recording in enumerate(batch.recordings, start=begin):
            true = drawn[place - begin]
            try:
                ready = prepare((recording,), situation.joint, threads=1, on_time=True)
            except InputError as error:
                raise InputError(
                    f"no motion was found that identifies the joint: {error.reason}",
                    remedy="allow more duration, velocity or acceleration, or give another controller",
                ) from error
            errors[place] = _refitted(ready, true, names) - np.array([true[n] for n in names])
        if observe is not None:
            observe(begin + len(seeds))
    return Rehearsal(names=names, errors=errors)


def _nearby(values: Mapping[str, float], seed: int) -> dict[str, float]:
    steps = np.random.default_rng(seed).uniform(-_APART, _APART, len(values))
    return {
        name: value * (1.0 + step)
        for (name, value), step in zip(values.items(), steps.tolist(), strict=True)
    }


def _refitted(ready: Prepared, true: Mapping[str, float], names: tuple[str, ...]) -> Array:
    domain = ready.domain
    start = np.array(
        [
            min(max(true.get(name, low), low), high)
            for name, low, high in zip(domain.names, domain.lower, domain.upper, strict=True)
        ]
    )
    parts = ready.problem.parts(ready.settings.windows)
    best = parts.refit(domain.lower, domain.upper, start, threads=1)
    best = balanced(domain.names, domain.lower, domain.upper, best)
    return np.asarray(best[[domain.names.index(name) for name in names]])
