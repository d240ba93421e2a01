"""`self_test`: simulate known parameters in the recorded motion, identify them again, and compare."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from jointid.base.errors import InputError
from jointid.estimate.estimate import Estimate
from jointid.estimate.record import EstimateRecord
from jointid.estimate.self_test import SelfTest, SelfTestRow
from jointid.estimate.statistics import ParameterEstimate
from jointid.identification.search.domain import SearchDomain
from jointid.identification.self_test.injection import Injection
from jointid.problem.problem import Problem
from jointid.problem.windows import Windows
from jointid.recording.recording import Recording

Array = NDArray[np.float64]

# Drawn values stay within this number of standard errors and within this factor of the estimate.
_WITHIN, _FACTOR = 1.96, 2.0
# A value is close if its error is below the first share of the truth or changes the torque by less than the second.
_CLOSE, _HARMLESS = 0.05, 0.005


def self_test(
    problem: Problem,
    domain: SearchDomain,
    windows: Windows,
    again: Callable[[tuple[Recording, ...]], Estimate],
    estimate: EstimateRecord,
    trials: int,
    seed: int,
) -> SelfTest:
    """Return the result of `Estimate.selftest`.

    Parameters
    ----------
    problem, domain, windows
        Input of the estimate.
    again : callable
        Function that returns the estimate from other recordings, with the same settings.
    """
    theta = np.array([estimate.parameters[name].value for name in domain.names])
    stream = np.random.SeedSequence(seed).spawn(trials + 1)
    injection = Injection(
        problem, windows, domain.names, theta, estimate.windows, np.random.default_rng(stream[-1])
    )
    rows: list[SelfTestRow] = []
    for trial in range(trials):
        rng = np.random.default_rng(stream[trial])
        truth = theta if trial == 0 else _drawn(estimate, domain, theta, rng)
        try:
            found = again(injection.recordings(truth, rng))
        except InputError as error:
            return SelfTest(rows=tuple(rows), trials=trials, seed=seed, failed=error.reason)
        sizes = injection.sizes(truth)
        rows += [
            _row(trial, found.parameters[name], float(truth[index]), float(sizes[index]))
            for index, name in enumerate(domain.names)
            if not domain.fixed(name)
        ]
    return SelfTest(rows=tuple(rows), trials=trials, seed=seed)


def _drawn(
    estimate: EstimateRecord, domain: SearchDomain, theta: Array, rng: np.random.Generator
) -> Array:
    """Return random parameters from the intervals of the estimate, with the correlation of its errors."""
    truth = theta.copy()
    errors = np.sqrt(np.diag(estimate.covariance))
    known = np.flatnonzero(np.isfinite(errors) & (errors > 0.0))
    normal = np.clip(rng.standard_normal(known.size), -_WITHIN, _WITHIN)
    if known.size:
        scaled = estimate.covariance[np.ix_(known, known)] / np.outer(errors[known], errors[known])
        values, vectors = np.linalg.eigh(scaled)
        step = errors[known] * (vectors @ (np.sqrt(np.maximum(values, 0.0)) * normal))
        step = np.clip(step, -_WITHIN * errors[known], _WITHIN * errors[known])
        for place, change in zip(known, step, strict=True):
            index = domain.names.index(estimate.free[place])
            truth[index] = _near(float(theta[index]), float(theta[index] + change))
    return np.clip(truth, domain.lower, domain.upper)


def _near(value: float, drawn: float) -> float:
    ends = sorted((value / _FACTOR, value * _FACTOR))
    return min(max(drawn, ends[0]), ends[1]) if value != 0.0 else drawn


def _row(trial: int, found: ParameterEstimate, truth: float, size: float) -> SelfTestRow:
    error = abs(found.value - truth)
    harmless = error == 0.0 or error * size <= _HARMLESS
    interval = found.interval
    if interval is not None and not all(np.isfinite(interval)):
        covered = True
    else:
        covered = harmless if interval is None else interval[0] <= truth <= interval[1]
    return SelfTestRow(
        trial=trial,
        parameter=found.name,
        unit=found.unit,
        truth=truth,
        value=found.value,
        interval=interval,
        covered=covered,
        close=harmless or error <= _CLOSE * abs(truth),
    )
