"""Starts of local searches."""

import numpy as np
from numpy.typing import NDArray

from peers.contest import Objective

NEAR = 0.2


def near_optimum(objective: Objective, seed: int) -> NDArray[np.float64]:
    """Return a start within 20 % of the optimum in every parameter, which a user rarely has."""
    rng = np.random.default_rng(seed)
    best = objective.contest.best
    start = best * (1.0 + rng.uniform(-NEAR, NEAR, best.size))
    return np.clip(start, objective.lower, objective.upper)
