"""Run the trials of a study. Trials with the same recording or penalty share it."""

from __future__ import annotations

import functools
import itertools
import math
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace

from jointid import _core
from jointid.base.errors import InputError
from jointid.estimate.estimate import Estimate
from jointid.identification.prepared import Prepared, prepare
from jointid.identification.search.run import Engine, Outcome, concluded, separable
from jointid.identification.search.search import Search
from jointid.joint.joint import Joint
from jointid.problem.settings import Settings
from jointid.recording.recording import Recording
from jointid.simulation.scenario import Scenario
from jointid.study.row import REFUSED, Row
from jointid.study.work import Place, Work

_Found = tuple[Row, Estimate | None]


def run_chunk(work: Work, places: Sequence[Place]) -> list[Row]:
    """Return the rows of some trials. An executor calls this in another process or on another machine."""
    return [row for rows in Runner(work).run(places) for row in rows]


class Runner:
    """Run trials group by group, and keep the last penalty for the next group.

    Parameters
    ----------
    work : Work
    strict : bool
        Whether invalid settings raise an error instead of giving refused rows. Default False.
    """

    def __init__(self, work: Work, *, strict: bool = False) -> None:
        self._work = work
        self._strict = strict
        self._ready: tuple[object, Prepared, Callable[[], Engine]] | None = None

    def run(self, places: Sequence[Place]) -> Iterator[list[Row]]:
        """Yield the rows of these trials, group by group as they are done.

        Raises
        ------
        InputError
            Settings are invalid, if strict.
        KeyboardInterrupt
            Ctrl-C.
        """
        work, subject = self._work, self._work.subject
        if isinstance(subject, Scenario):
            for _, group in itertools.groupby(places, key=lambda place: work.world(place[0])):
                yield from self._simulated(list(group), subject)
            return
        for analysis, group in itertools.groupby(places, key=lambda p: work.analysis(p[0])):
            found = self._searched(list(group), subject, analysis)
            yield [row for row, _ in found]

    def _simulated(self, places: list[Place], subject: Scenario) -> Iterator[list[Row]]:
        """Run the trials of one scenario: simulate its recordings together, then identify each."""
        work = self._work
        world = work.world(places[0][0])
        trials = sorted({trial for _, trial in places})
        try:
            scenario = work.cells[places[0][0]].scenario(subject)
        except InputError as error:
            yield [self._refused(place, error) for place in places]
            return
        recordings = self._recordings(scenario, trials)
        for (trial, analysis), group in itertools.groupby(
            places, key=lambda place: (place[1], work.analysis(place[0]))
        ):
            made = recordings[trial]
            if isinstance(made, InputError):
                yield [self._refused(place, made) for place in group]
                continue
            key = world, trial, analysis
            found = self._searched(list(group), (made,), key, scenario)
            yield self._tracked(found, scenario) if work.tracking else [row for row, _ in found]

    def _recordings(
        self, scenario: Scenario, trials: list[int]
    ) -> dict[int, Recording | InputError]:
        """Return the recording of each trial, or the error of an unstable loop."""
        work = self._work
        seeds = [work.seed + trial for trial in trials]
        try:
            batch = scenario.simulate(seeds, threads=work.threads)
        except InputError as error:
            if len(trials) == 1:
                return {trials[0]: error}
            # One of them failed: simulate each separately to keep the others.
            alone = [self._recordings(scenario, [trial]) for trial in trials]
            return {trial: made for each in alone for trial, made in each.items()}
        return dict(zip(trials, batch.recordings, strict=True))

    def _searched(
        self,
        places: list[Place],
        recordings: tuple[Recording, ...],
        key: object,
        scenario: Scenario | None = None,
    ) -> list[_Found]:
        """Run trials on one penalty together."""
        work = self._work
        options = work.cells[places[0][0]].options(work.common)
        joint = scenario.joint if scenario is not None and work.joint is None else work.joint
        started = time.perf_counter()
        try:
            searches = [
                work.cells[cell].search(work.search, work.seed + trial, work.threads)
                for cell, trial in places
            ]
            if self._ready is None or self._ready[0] != key:
                self._ready = None  # frees the memory of the last penalty first
                prepared = prepare(recordings, joint, Settings.of(options), threads=work.threads)
                # A search by projection needs no penalty.
                engine: Callable[[], Engine] = functools.cache(
                    functools.partial(Engine.of, prepared.penalty, prepared.domain, work.threads)
                )
                self._ready = key, prepared, engine
            _, prepared, engine = self._ready
            outcomes = _outcomes(searches, prepared, engine)
        except InputError as error:
            return [(self._refused(place, error), None) for place in places]
        return [
            self._found(place, prepared, search, outcome, started)
            for place, search, outcome in zip(places, searches, outcomes, strict=True)
        ]

    def _found(
        self, place: Place, prepared: Prepared, search: Search, outcome: Outcome, started: float
    ) -> _Found:
        work = self._work
        row = Row(
            cell=place[0],
            trial=place[1],
            seed=search.seed,
            status=outcome.status,
            message=outcome.message,
            penalty=prepared.penalty(outcome.best),
            evaluations=outcome.evaluations,
            generations=outcome.generations,
            values=dict(zip(prepared.penalty.names, outcome.best.tolist(), strict=True)),
        )
        if not (work.standard_errors or work.tracking):
            return row, None
        estimate = prepared.estimate(search, outcome, started)
        if work.standard_errors:
            known = ((name, p.stderr) for name, p in estimate.parameters.items())
            row = replace(row, stderr={name: e for name, e in known if e is not None})
        return row, estimate

    def _tracked(self, found: list[_Found], scenario: Scenario) -> list[Row]:
        """Return rows with the tracking error before, after, and with the true parameters."""
        seed = found[0][0].seed
        errors = {
            "before": self._error(scenario, None, seed),
            "true": self._error(scenario, scenario.joint, seed),
        }
        rows = []
        for row, estimate in found:
            after = math.nan
            if estimate is not None:
                after = self._error(scenario, estimate.joint, seed)
            rows.append(
                replace(
                    row,
                    tracking={
                        "before": errors["before"],
                        "after": after,
                        "true": errors["true"],
                    },
                )
            )
        return rows

    def _error(self, scenario: Scenario, believed: Joint | None, seed: int) -> float:
        """Return the tracking error of the unchanged controller, or with a joint's parameters."""
        try:
            law = scenario.controller if believed is None else scenario.believing(believed)
        except InputError:  # no controller compensates this friction model
            return math.nan
        try:
            batch = scenario.simulate(seed, controllers=law, recordings=False, threads=1)
        except InputError:  # a loop that is unstable with these estimates
            return math.inf
        return float(batch.error[0])

    def _refused(self, place: Place, error: InputError) -> Row:
        if self._strict:
            raise error
        # Without advice, which depends on the interface (Python, command line, app): any of them may read a row.
        plain = InputError(
            error.reason, argument=error.argument, value=error.value, place=error.place
        )
        return Row(
            cell=place[0],
            trial=place[1],
            seed=self._work.seed + place[1],
            status=REFUSED,
            message=str(plain),
        )


def _outcomes(
    searches: list[Search], prepared: Prepared, engine: Callable[[], Engine]
) -> list[Outcome]:
    penalty, domain = prepared.penalty, prepared.domain
    if searches[0].chosen_method == "separable":  # this method has no seed
        return [separable(searches[0], penalty, domain, engine)] * len(searches)
    ready = engine()
    results = _core.minimise_trials(
        ready.form,
        domain.lower,
        domain.upper,
        options=[search.genetic for search in searches],
        seeds=[search.seed for search in searches],
        random=searches[0].chosen_method == "random",
        threads=searches[0].threads,
    )
    return [
        concluded(search, ready, domain, result, result.generations)
        for search, result in zip(searches, results, strict=True)
    ]
