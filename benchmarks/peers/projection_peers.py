"""Variable projection in the contest: usual searches over the one shape, with the rest eliminated."""

from __future__ import annotations

from collections.abc import Callable

import cma
import numpy as np
import pygmo
from numpy.typing import NDArray
from scipy.optimize import Bounds, differential_evolution, minimize_scalar

from peers.contest import Contest, Objective
from peers.peer import Peer, Solve
from peers.projection import Projection, compiled_decay, numpy_decay

NAME = "variable projection, SciPy minimize_scalar"
ELIMINATED = "columns: the rest is eliminated"

_MADE: dict[tuple[int, bool], Projection] = {}

Value = Callable[[float], float]


def projection_of(contest: Contest, *, compiled: bool) -> Projection:
    """Return the projection, made once, because a peer receives it ready."""
    key = (id(contest), compiled)
    if key not in _MADE:
        direct = contest.direct
        decay = compiled_decay(direct) if compiled else numpy_decay(*contest.sums())
        _MADE[key] = Projection(direct, contest.full_lower, contest.full_upper, decay)
    return _MADE[key]


def over_shapes(search: Callable[[Value, float, int], None]) -> Solve:
    """Search over the root of the shape, which is like a speed, from 0 to its upper bound."""

    def solve(objective: Objective, seed: int) -> None:
        contest = objective.contest
        penalty = projection_of(contest, compiled=objective.compiled)
        highest = float(np.sqrt(contest.full_upper[-1]))

        def value(root: float) -> float:
            return objective.settled(penalty(np.array([root * root])))

        search(value, highest, seed)

    return solve


def scalar(value: Value, highest: float, seed: int) -> None:
    """Brent's method in the bounds."""
    del seed
    minimize_scalar(value, bounds=(0.0, highest), method="bounded", options={"xatol": 1e-9})


def evolution(value: Value, highest: float, seed: int) -> None:
    """SciPy's differential evolution."""

    def first(x: NDArray[np.float64]) -> float:
        return value(float(x[0]))

    differential_evolution(first, Bounds([0.0], [highest]), rng=np.random.default_rng(seed))


def strategy(value: Value, highest: float, seed: int) -> None:
    """Run CMA-ES. pycma needs two dimensions; the second has no effect."""

    def first(x: NDArray[np.float64]) -> float:
        return value(highest * float(x[0]))

    start = np.random.default_rng(seed).uniform(0.0, 1.0, 2)
    options = {"bounds": [0.0, 1.0], "seed": seed + 1, "verbose": -9, "tolfun": 1e-14}
    cma.fmin2(first, start, 0.3, options)


class _Problem:
    """Methods that pygmo requires of a user's problem."""

    def __init__(self, value: Value, highest: float) -> None:
        self.value, self.highest = value, highest

    def fitness(self, x: NDArray[np.float64]) -> list[float]:
        return [self.value(float(x[0]))]

    def get_bounds(self) -> tuple[list[float], list[float]]:
        return [0.0], [self.highest]


def genetic(value: Value, highest: float, seed: int) -> None:
    """Pygmo's SGA with SBX."""
    problem = pygmo.problem(_Problem(value, highest))
    population = pygmo.population(problem, size=20, seed=seed)
    method = pygmo.sga(gen=200, crossover="sbx", mutation="polynomial", seed=seed)
    pygmo.algorithm(method).evolve(population)


def peers() -> list[Peer]:
    """Return each peer with both forms of the shaped column."""
    rows = {
        NAME: scalar,
        "SciPy differential_evolution, eliminated": evolution,
        "pycma fmin2, eliminated": strategy,
        "pygmo sga, eliminated": genetic,
    }
    return [
        Peer(name=name, form=form, solve=over_shapes(search), given=ELIMINATED)
        for name, search in rows.items()
        for form in ("NumPy", "compiled")
    ]
