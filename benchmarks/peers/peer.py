"""A row of the contest, and the timing of one run of it."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import asdict, dataclass
from typing import Any

from peers.contest import Contest, Expired, Objective, Reached

Solve = Callable[[Objective, int], None]


@dataclass(frozen=True, slots=True, kw_only=True)
class Peer:
    """One row.

    Attributes
    ----------
    name : str
        Name with its settings, as the table shows it.
    form : str
        "NumPy", "compiled" or "compressed": the form of its penalty.
    solve : callable
        Takes an objective and a seed, and searches until the objective ends it. A search that ends earlier
        is started again with another seed until the limit.
    given : str
        Information that it uses.
    whole : bool
        Whether it runs to its own end; it returns its penalty in `objective.best`.
    """

    name: str
    form: str
    solve: Solve
    given: str = "values"
    whole: bool = False

    @property
    def key(self) -> str:
        """Name and form."""
        return f"{self.name} | {self.form}"


@dataclass(frozen=True, slots=True, kw_only=True)
class Run:
    """Result of one run; `ratio` is the best penalty over the optimum's."""

    peer: str
    seed: int
    seconds: float
    reached: bool
    ratio: float
    evaluations: int
    starts: int

    def asdict(self) -> dict[str, Any]:
        """Return the fields as a dictionary."""
        return asdict(self)


def timed(peer: Peer, contest: Contest, seed: int, limit: float) -> Run:
    """Time one run, from call to stop."""
    objective = Objective(contest, compiled=peer.form != "NumPy", limit=limit)
    began = time.perf_counter()
    reached = False
    try:
        while True:
            peer.solve(objective, seed + 1000 * objective.starts)
            objective.starts += 1
            if peer.whole:
                reached = objective.best <= contest.target
                break
            if time.perf_counter() - began > limit:
                break
    except Reached:
        reached = True
    except Expired:
        pass
    return Run(
        peer=peer.key,
        seed=seed,
        seconds=time.perf_counter() - began,
        reached=reached,
        ratio=objective.best / contest.best_penalty,
        evaluations=objective.evaluations,
        starts=objective.starts,
    )
