"""Effect of the residual's choice, "torque" or "sensor", on each parameter."""

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
    """Return the change of each parameter with the other residual; None if no side is chosen.

    With the residual "torque", noise of the reading makes the gain too small. With "sensor", friction that the model
    lacks makes it too large. The true gain is between. A gain by instruments needs no side.

    Parameters
    ----------
    windows : int, float, str, WindowOptions or None
        Windows of the call.
    best : ndarray, shape (p,)
        Estimated parameters.
    """
    other = _OTHER.get(problem.choice.residual)
    gain = "sensor_gain"
    if other is None or gain not in domain.names or domain.fixed(gain) or windows == "cumulative":
        return None
    parts = replace(problem, choice=replace(problem.choice, residual=other)).parts(windows)
    found = parts.refit(domain.lower, domain.upper, best, threads=problem.threads)
    return np.abs(found - best)
