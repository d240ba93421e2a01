"""Errors counted in simulated recordings: the motion, the controller, the noise, and the identification itself."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from jointid.design.judging import Situation
from jointid.identification.prepared import prepare
from jointid.identification.search.run import run_search
from jointid.identification.search.search import Search
from jointid.problem.constant_torque import balanced
from jointid.simulation.batch import simulate_batch
from jointid.simulation.trajectory import Trajectory

Array = NDArray[np.float64]

_TOGETHER = 16  # recordings that are simulated at once


@dataclass(frozen=True, slots=True, kw_only=True)
class Rehearsal:
    """Errors of identifications from simulated recordings of one motion.

    Attributes
    ----------
    names : tuple of str
    errors : ndarray, shape (recordings, p)
        Identified less true.
    """

    names: tuple[str, ...]
    errors: Array

    def rms(self) -> dict[str, float]:
        """Return the root mean square of each parameter's error."""
        size = np.sqrt(np.mean(self.errors**2, axis=0))
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
    """Simulate `count` recordings of the joint with these values, and identify each.

    Parameters
    ----------
    situation : Situation
    trajectory : Trajectory
    values : mapping of str to float
        Of the free parameters.
    count : int
    first : int
        Seed of the first recording's noise. Default 0.
    threads : int
        0 (default): all.
    observe : callable, optional
        Called with how many are done.
    """
    names = situation.asked.names
    true = situation.with_values(values)
    truth = np.array([values[name] for name in names])
    # The minimum is the same whichever search finds it.
    search = Search("separable", threads=1)
    errors = np.empty((count, len(names)))
    for begin in range(0, count, _TOGETHER):
        seeds = list(range(first + begin, first + min(begin + _TOGETHER, count)))
        batch = simulate_batch(
            true,
            situation.controller,
            trajectory,
            control_period=situation.control_period,
            sensors=situation.sensors,
            seeds=seeds,
            recordings=True,
            threads=threads,
        )
        for place, recording in enumerate(batch.recordings, start=begin):
            ready = prepare(recording, situation.joint, threads=1, on_time=True)
            domain = ready.domain
            best = run_search(search, ready.penalty, domain).best
            best = balanced(domain.names, domain.lower, domain.upper, best)
            found = dict(zip(domain.names, best.tolist(), strict=True))
            errors[place] = np.array([found[name] for name in names]) - truth
        if observe is not None:
            observe(begin + len(seeds))
    return Rehearsal(names=names, errors=errors)
