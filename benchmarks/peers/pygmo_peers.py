"""pygmo: its simple genetic algorithm with SBX, self-adaptive differential evolution, DE and CMA-ES."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pygmo

from peers.contest import Objective
from peers.peer import Peer, Solve

FOREVER = 1_000_000  # generations: the target or the limit ends the run
CANONICAL = 9  # CMA-ES's own value for six parameters: 4 + 3 ln n, which is pycma's default, too
TIGHT = 1e-14  # its tolerances are absolute, and the penalty is of the order of 1e-4


class _Problem:
    """The user-defined problem of the manual, over the unit box."""

    def __init__(self, objective: Objective) -> None:
        self._objective = objective

    def __deepcopy__(self, memo: object) -> _Problem:
        return self  # pygmo copies problems, but there is one count of the evaluations

    def fitness(self, x: Any) -> list[float]:
        return [self._objective.unit(x)]

    def get_bounds(self) -> tuple[list[float], list[float]]:
        size = self._objective.size
        return [0.0] * size, [1.0] * size


def solver(make: Callable[[int], Any], population: int) -> Solve:
    """Population and evolution as in the manual's tutorial."""

    def solve(objective: Objective, seed: int) -> None:
        start = pygmo.population(pygmo.problem(_Problem(objective)), population, seed=seed)
        pygmo.algorithm(make(seed)).evolve(start)

    return solve


def simple_genetic(seed: int) -> Any:
    """SBX, and polynomial mutation of one gene in six."""
    return pygmo.sga(
        gen=FOREVER,
        cr=0.9,
        eta_c=10.0,
        m=1.0 / 6.0,
        param_m=20.0,
        crossover="sbx",
        mutation="polynomial",
        seed=seed,
    )


def peers() -> list[Peer]:
    """Each with both forms of the penalty."""
    tight = {"gen": FOREVER, "ftol": TIGHT, "xtol": TIGHT}
    rows = {
        "pygmo sga, SBX, population 100": solver(simple_genetic, 100),
        "pygmo de, population 20": solver(lambda seed: pygmo.de(**tight, seed=seed), 20),
        "pygmo sade, population 20": solver(lambda seed: pygmo.sade(**tight, seed=seed), 20),
        f"pygmo cmaes, population {CANONICAL}": solver(
            lambda seed: pygmo.cmaes(**tight, force_bounds=True, seed=seed), CANONICAL
        ),
    }
    return [
        Peer(name=name, form=form, solve=solve)
        for name, solve in rows.items()
        for form in ("NumPy", "compiled")
    ]
