"""What the choice of the compared signal means for each parameter."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from jointid.identification.search.domain import SearchDomain
from jointid.problem.problem import Problem
from jointid.problem.windows import Windows

Array = NDArray[np.float64]

_OTHER = {"sensor": "torque", "torque": "sensor"}


def of_residual_side(
    problem: Problem, windows: Windows, domain: SearchDomain, best: Array
) -> Array | None:
    """Return how far each parameter moves when the other side is compared; None where no side is chosen.

    Noise of the reading makes the gain too small on one side, friction that the model lacks makes it too large on
    the other: the truth lies between. A gain by instruments needs no side.

    Parameters
    ----------
    windows : int, float, str, WindowOptions or None
        As given in the call.
    best : ndarray, shape (p,)
        The parameters found.
    """
    other = _OTHER.get(problem.choice.residual)
    gain = "sensor_gain"
    if other is None or gain not in domain.names or domain.fixed(gain) or windows == "cumulative":
        return None
    parts = replace(problem, choice=replace(problem.choice, residual=other)).parts(windows)
    found = parts.refit(domain.lower, domain.upper, best, threads=problem.threads)
    return np.abs(found - best)
