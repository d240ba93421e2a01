"""Block bootstrap of an estimate."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.balance.resampling import cells_of, draws
from jointid.estimate.bootstrap import Bootstrap, BootstrapParameter
from jointid.estimate.record import EstimateRecord
from jointid.estimate.statistics import ParameterEstimate
from jointid.estimate.student import quantile
from jointid.identification.inference.motion import Motion
from jointid.identification.search.domain import SearchDomain
from jointid.problem.problem import Problem

Array = NDArray[np.float64]

_NEAR = 3.0  # standard errors from a bound
_OFTEN = 0.01  # share of the draws that end on a bound
_MIDDLE = (0.158655, 0.841345)  # quantiles at ±1 standard deviation of a normal distribution


def block_bootstrap(
    problem: Problem,
    penalty: _core.Penalty,
    domain: SearchDomain,
    estimate: EstimateRecord,
    count: int,
    seed: int,
) -> Bootstrap:
    """Return the block bootstrap of an estimate from this problem."""
    names = [name for name in domain.names if not domain.fixed(name)]
    places = [domain.names.index(name) for name in names]
    best = np.array([estimate.parameters[name].value for name in domain.names])
    _, residual, jacobian = penalty.linearised(best)
    motion = Motion.of(problem, penalty)
    end = np.cumsum(motion.moved)
    cells = cells_of(
        jacobian[:, places],
        residual,
        recording=motion.recording,
        begin=np.append(0.0, end[:-1]),
        end=end,
        length=motion.segment_length,
    )
    here = best[places]
    below, above = domain.lower[places] - here, domain.upper[places] - here
    moved = draws(cells, below, above, count, seed)
    freedom = max(1, cells.blocks - 1)
    return Bootstrap(
        parameters={
            name: drawn_parameter(
                estimate.parameters[name], moved[:, i], (below[i], above[i]), freedom
            )
            for i, name in enumerate(names)
        },
        samples=here + moved,
        block=motion.segment_length,
        blocks=cells.blocks,
        seed=seed,
    )


def drawn_parameter(
    p: ParameterEstimate, moved: Array, room: tuple[float, float], freedom: int
) -> BootstrapParameter:
    """Return the bootstrap result of one parameter.

    Parameters
    ----------
    p : ParameterEstimate
    moved : ndarray, shape (n,)
        Change of the parameter in each draw.
    room : (float, float)
        Largest change down (negative) and up (positive) within the bounds.
    freedom : int
        Degrees of freedom of Student's t.
    """
    # Quantiles instead of the standard deviation: a draw without one direction of motion may end anywhere.
    left, right = np.quantile(moved, _MIDDLE)
    stderr = 0.5 * float(right - left)
    below, above = room
    on_one = np.mean((moved <= below) | (moved >= above))
    near = bool(min(-below, above) < _NEAR * stderr or on_one > _OFTEN)
    if near:
        low, high = np.quantile(moved, (0.025, 0.975))
    else:
        high = quantile(0.975, freedom) * stderr
        low = -high
    if p.stderr == np.inf:  # nothing determines the parameter, although the draws have values
        stderr, low, high = np.inf, -np.inf, np.inf
    usable = p.stderr is not None and 0.0 < p.stderr < np.inf
    return BootstrapParameter(
        name=p.name,
        unit=p.unit,
        value=p.value,
        stderr=stderr,
        interval=(p.value + float(low), p.value + float(high)),
        ratio=stderr / p.stderr if p.stderr is not None and usable else None,
        near_bound=near,
    )
