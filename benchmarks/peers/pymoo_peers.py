"""pymoo: GA and DE with their defaults, a vectorised problem as its manual advises."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from pymoo.algorithms.soo.nonconvex.de import DE
from pymoo.algorithms.soo.nonconvex.ga import GA
from pymoo.core.problem import Problem
from pymoo.optimize import minimize

from peers.contest import Objective
from peers.peer import Peer, Solve

FOREVER = 1_000_000


class _Problem(Problem):  # type: ignore[misc]
    """A population a call."""

    def __init__(self, objective: Objective) -> None:
        super().__init__(n_var=objective.size, n_obj=1, xl=objective.lower, xu=objective.upper)
        self.objective = objective

    def __deepcopy__(self, memo: object) -> _Problem:
        return self  # one count of the evaluations

    def _evaluate(self, x: np.ndarray, out: dict[str, Any], *_: Any, **__: Any) -> None:
        out["F"] = self.objective.many(x)[:, None]


def solver(make: Callable[[], Any]) -> Solve:
    """`minimize` until the target."""

    def solve(objective: Objective, seed: int) -> None:
        minimize(_Problem(objective), make(), ("n_gen", FOREVER), seed=seed, verbose=False)

    return solve


def peers() -> list[Peer]:
    """Each with both forms of the penalty."""
    rows = {
        "pymoo GA, population 100": solver(lambda: GA(pop_size=100)),
        "pymoo DE, population 100": solver(lambda: DE(pop_size=100)),
    }
    return [
        Peer(name=name, form=form, solve=solve)
        for name, solve in rows.items()
        for form in ("NumPy", "compiled")
    ]
