"""The work of a study: its trials, their order, and the chunks for an executor."""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from jointid.identification.search.search import Search
from jointid.joint.joint import Joint
from jointid.recording.recording import Recording
from jointid.simulation.scenario import Scenario
from jointid.study.cell import Cell, is_option

Place = tuple[int, int]  # cell and trial

# Cost of a trial without its search's candidates, in candidates (0.1 µs each).
_TRIAL, _SIMULATION = 10_000, 100_000
_CHUNK = 2_000_000
_PER_SAMPLE = (
    13  # chunks are larger for long recordings, because sending and preparing them takes longer
)


@dataclass(frozen=True, slots=True, kw_only=True)
class Work:
    """All data that trials need; sent to the process that runs them.

    Attributes
    ----------
    subject : tuple of Recording, or Scenario
    joint : Joint or None
    common : dict of str to object
        Options of a problem, equal in all cells.
    search : Search
        The search. Trial t adds t to its seed.
    cells : tuple of Cell
    standard_errors, tracking : bool
        Whether rows include them.
    threads : int
        Number of threads. 0: all processors.
    """

    subject: tuple[Recording, ...] | Scenario
    joint: Joint | None
    common: dict[str, Any]
    search: Search
    cells: tuple[Cell, ...]
    standard_errors: bool
    tracking: bool
    threads: int

    @property
    def seed(self) -> int:
        """Seed of the first trial."""
        return self.search.seed

    @property
    def trials_differ(self) -> bool:
        """Whether the noise of a simulation or a random search makes trials differ."""
        if isinstance(self.subject, Scenario):
            return True
        methods = {each.search(self.search, self.seed, 1).chosen_method for each in self.cells}
        return methods != {"separable"}

    def ordered(self, trials: int, done: Iterable[Place]) -> list[Place]:
        """Return the remaining trials. Trials that share a recording or a penalty follow each other."""
        left = set(itertools.product(range(len(self.cells)), range(trials))) - set(done)
        simulated = isinstance(self.subject, Scenario)

        def key(place: Place) -> tuple[Any, ...]:
            cell, trial = place
            world, analysis = self.world(cell), self.analysis(cell)
            return (world, trial, analysis, cell) if simulated else (analysis, cell, trial)

        return sorted(left, key=key)

    def world(self, cell: int) -> str:
        """Return the cell's settings of the scenario, as a key."""
        labels = self.cells[cell].labels
        return repr([(n, label) for n, label in labels.items() if not is_option(n)])

    def analysis(self, cell: int) -> str:
        """Return the cell's settings of the penalty and the method, as a key."""
        labels = self.cells[cell].labels
        mine = [n for n in labels if is_option(n) and n.partition(".")[0] != "ga"]
        return repr([(n, labels[n]) for n in mine])

    def chunks(self, places: Sequence[Place]) -> Iterator[tuple[Place, ...]]:
        """Yield parts of the work that each take some tenths of a second, with at least one trial."""
        limit = _CHUNK
        if not isinstance(self.subject, Scenario):
            limit = max(limit, _PER_SAMPLE * sum(len(run) for run in self.subject))
        chunk: list[Place] = []
        cost = 0
        for place in places:
            more = self._cost(place[0])
            if chunk and cost + more > limit:
                yield tuple(chunk)
                chunk, cost = [], 0
            chunk.append(place)
            cost += more
        if chunk:
            yield tuple(chunk)

    def _cost(self, cell: int) -> int:
        options = self.cells[cell].search(self.search, self.seed, self.threads).genetic
        fixed = _TRIAL + (_SIMULATION if isinstance(self.subject, Scenario) else 0)
        return options.population * options.islands * (options.generations + 1) + fixed
