"""A row of the contest, and how one run of it is timed."""

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
        With its settings, as the table shows it.
    form : str
        "NumPy", "compiled" or "compressed": the penalty it is handed.
    solve : callable
        Takes an objective and a seed, and searches until the objective ends it. A search that ends by
        itself is started again with another seed until the limit.
    given : str
        What it makes use of.
    whole : bool
        Runs to its own end; it returns the penalty it found, in `objective.best`.
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
    """What one run gave; `ratio` is the best penalty over the optimum's."""

    peer: str
    seed: int
    seconds: float
    reached: bool
    ratio: float
    evaluations: int
    starts: int

    def asdict(self) -> dict[str, Any]:
        """The fields as a dictionary."""
        return asdict(self)


def timed(peer: Peer, contest: Contest, seed: int, limit: float) -> Run:
    """One run, from call to stop."""
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
