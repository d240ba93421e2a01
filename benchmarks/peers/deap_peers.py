"""DEAP: `eaSimple` with bounded SBX, bounded polynomial mutation and tournaments."""

from __future__ import annotations

import random
from typing import Any

import numpy as np
from deap import algorithms, base, creator, tools

from peers.contest import Objective
from peers.peer import Peer

POPULATION = 100
FOREVER = 1_000_000

creator.create("Minimum", base.Fitness, weights=(-1.0,))
creator.create("Individual", list, fitness=creator.Minimum)


def genetic(objective: Objective, seed: int) -> None:
    """As in the manual's examples, over the unit box."""
    random.seed(seed)
    size = objective.size

    def evaluate(individual: list[float]) -> tuple[float]:
        return (objective.unit(np.array(individual)),)

    toolbox: Any = base.Toolbox()
    toolbox.register("gene", random.random)
    toolbox.register("individual", tools.initRepeat, creator.Individual, toolbox.gene, size)
    toolbox.register("population", tools.initRepeat, list, toolbox.individual)
    toolbox.register("evaluate", evaluate)
    toolbox.register("mate", tools.cxSimulatedBinaryBounded, eta=20.0, low=0.0, up=1.0)
    toolbox.register(
        "mutate", tools.mutPolynomialBounded, eta=20.0, low=0.0, up=1.0, indpb=1.0 / size
    )
    toolbox.register("select", tools.selTournament, tournsize=3)
    algorithms.eaSimple(
        toolbox.population(n=POPULATION), toolbox, 0.9, 0.2, ngen=FOREVER, verbose=False
    )


def peers() -> list[Peer]:
    """With both forms of the penalty."""
    name = f"DEAP eaSimple, SBX, population {POPULATION}"
    return [Peer(name=name, form=form, solve=genetic) for form in ("NumPy", "compiled")]
