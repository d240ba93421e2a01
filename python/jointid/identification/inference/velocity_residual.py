"""Causes that noise of the velocity imitates: near a reversal, a coarse position leaves a systematic residual."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.base.errors import InputError
from jointid.estimate.causes import Cause
from jointid.identification.inference.velocity_noise import is_noisy, measured_again
from jointid.problem.inner_products import inner
from jointid.problem.problem import Problem
from jointid.recording.order_statistics import median

Array = NDArray[np.float64]

# Names of causes that noise of the velocity imitates. The last ones are exponents of the Stribeck decay.
IMITATED = (
    "slow_motion",
    "smooth_friction",
    "presliding",
    "delay",
    *dict.fromkeys(
        name
        for term in _core.terms()
        for name in term.shapes
        if term.friction and _core.shape(name).speed_power == 0.0
    ),
)
_DRAWS = 4


def beyond_velocity_noise(
    problem: Problem,
    penalty: _core.Penalty,
    best: Array,
    free: Sequence[int],
    causes: Sequence[Cause],
) -> tuple[Cause, ...]:
    """Return the causes without those that noise of the velocity explains.

    Parameters
    ----------
    problem : Problem
        Problem with noisy velocities.
    penalty : Penalty
        Penalty over the windows of the fit.
    best : ndarray, shape (p,)
    free : sequence of int
        Indices of the free parameters.
    causes : sequence of Cause

    Notes
    -----
    Adding the same amount of noise to the velocity again increases the residual by as much as the original noise did.
    An imitated cause that explains a smaller share of the residual cannot be distinguished from noise.
    """
    if not any(each.name in IMITATED for each in causes):
        return tuple(causes)
    scales = {each: max(1, round(each.scale / penalty.window_duration)) for each in causes}
    wanted = sorted({scales[each] for each in causes if each.name in IMITATED})
    added = _added(problem, penalty, best, list(free), wanted)
    return tuple(
        each for each in causes if each.name not in IMITATED or each.share > added[scales[each]]
    )


def _added(
    problem: Problem, penalty: _core.Penalty, best: Array, free: list[int], factors: list[int]
) -> dict[int, float]:
    """Return the relative increase of the squared residual at each scale when the noise is added again."""
    before = _misfits(penalty, best, free, factors)
    after = []
    options = _core.WindowOptions(
        duration=penalty.window_duration, cumulative=bool(penalty.cumulative)
    )
    for draw in range(_DRAWS):
        runs = tuple(
            measured_again(run, draw, number) if is_noisy(run, penalty.noise_share) else run
            for number, run in enumerate(problem.recordings)
        )
        try:
            other = dataclasses.replace(problem, recordings=runs).penalty(options)
            if penalty.residual == _core.Residual.instruments:
                other.project_reading(free, threads=problem.threads)
        except InputError:  # with the added noise, the joint seems to stand still
            continue
        after.append(_misfits(other, best, free, factors))
    return {
        factor: median([each[factor] for each in after]) / before[factor] - 1.0
        if after and before[factor] > 0.0
        else 0.0
        for factor in factors
    }


def _misfits(
    penalty: _core.Penalty, best: Array, free: list[int], factors: list[int]
) -> dict[int, float]:
    """Return the mean square of the residual's sums over `factors` windows, with parameters refitted to first order."""
    _, residual, jacobian = penalty.linearised(best)
    columns = jacobian[:, free]
    size = np.sqrt(np.einsum("ij,ij->j", columns, columns))
    columns = columns / np.where(size > 0.0, size, 1.0)
    square = np.einsum("ni,nj->ij", columns, columns) + 1e-12 * np.eye(len(free))
    left = residual - columns @ np.linalg.solve(square, np.einsum("ni,n->i", columns, residual))
    found = {}
    for factor in factors:
        sums = np.add.reduceat(left, np.arange(0, len(left), factor))
        found[factor] = inner(sums, sums) / len(left)
    return found
