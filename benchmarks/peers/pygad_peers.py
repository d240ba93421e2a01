"""PyGAD: its defaults for floats, fitness 1 / penalty and batches as its manual shows."""

from __future__ import annotations

from typing import Any

import numpy as np
import pygad

from peers.contest import Objective
from peers.peer import Peer

POPULATION = 100
FOREVER = 1_000_000


def genetic(objective: Objective, seed: int) -> None:
    """Defaults: steady-state selection, one point, one random gene mutated, one elite."""

    def fitness(_: Any, solutions: Any, __: Any) -> Any:
        return 1.0 / objective.many_unit(np.asarray(solutions, dtype=np.float64))

    pygad.GA(
        num_generations=FOREVER,
        num_parents_mating=POPULATION // 2,
        sol_per_pop=POPULATION,
        num_genes=objective.size,
        gene_space={"low": 0.0, "high": 1.0},
        fitness_func=fitness,
        fitness_batch_size=POPULATION,
        random_seed=seed,
        suppress_warnings=True,
    ).run()


def peers() -> list[Peer]:
    """With both forms of the penalty."""
    name = f"PyGAD, population {POPULATION}"
    return [Peer(name=name, form=form, solve=genetic) for form in ("NumPy", "compiled")]
