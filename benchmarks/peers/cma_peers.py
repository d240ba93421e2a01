"""pycma: CMA-ES over the unit box, with restarts of growing population."""

from __future__ import annotations

import cma
import numpy as np

from peers.contest import Objective
from peers.peer import Peer


def one_by_one(objective: Objective, seed: int) -> None:
    """`fmin2` with bounds and restarts, as the documentation advises for a multimodal function."""
    rng = np.random.default_rng(seed)
    cma.fmin2(
        objective.unit,
        lambda: rng.uniform(0.0, 1.0, objective.size),
        0.3,
        {"bounds": [0.0, 1.0], "seed": seed + 1, "verbose": -9, "tolfun": 1e-14},
        restarts=9,
    )


def populations(objective: Objective, seed: int) -> None:
    """Search by ask and tell, one population per call."""
    rng = np.random.default_rng(seed)
    strategy = cma.CMAEvolutionStrategy(
        rng.uniform(0.0, 1.0, objective.size),
        0.3,
        {"bounds": [0.0, 1.0], "seed": seed + 1, "verbose": -9, "tolfun": 1e-14},
    )
    while not strategy.stop():
        candidates = strategy.ask()
        strategy.tell(candidates, list(objective.many_unit(np.array(candidates))))


def peers() -> list[Peer]:
    """Return each variant with both forms of the penalty; the population is pycma's own, 4 + 3 ln 6."""
    ways = {"pycma fmin2, restarts": one_by_one, "pycma ask and tell": populations}
    return [
        Peer(name=name, form=form, solve=solve)
        for name, solve in ways.items()
        for form in ("NumPy", "compiled")
    ]
