"""Time of each step of a whole `identify(search="ga")`, each timed alone after other work."""

from __future__ import annotations

import statistics
import time

import numpy as np
from peers.contest import WINDOWS, Contest
from store import Record

import jointid as jid
from jointid import _core
from jointid.identification.prepared import prepare
from jointid.identification.search.run import Engine, Outcome
from jointid.identification.search.search import Search
from jointid.problem.settings import Settings

STEPS = ("prepare", "compress", "genetic search", "polish", "inference")
REPEATS = 31
BEHIND = 0.1  # [s] of NumPy before each repeat: caches are cold, the other processors asleep


def once(contest: Contest, windows: int | None) -> dict[str, float]:
    """Return the seconds of each step of `identify(search="ga")`."""
    options = _core.GaOptions()
    search = Search("ga", ga=options)
    marks = [time.perf_counter()]
    prepared = prepare((contest.recording,), contest.joint, Settings.of({"windows": windows}))
    marks.append(time.perf_counter())
    engine = Engine.of(prepared.penalty, prepared.domain, 0)
    marks.append(time.perf_counter())
    low, high = prepared.domain.lower, prepared.domain.upper
    found = _core.minimise_genetic(engine.form, low, high, options=options, seed=0)
    marks.append(time.perf_counter())
    best, _, settled = engine.polished(prepared.domain, found.best)
    assert settled
    marks.append(time.perf_counter())
    outcome = Outcome(best=best, convergence=None, status="converged", message="")
    prepared.estimate(search, engine.verified(outcome, prepared.domain), marks[0])
    marks.append(time.perf_counter())
    return dict(zip(STEPS, np.diff(marks).tolist(), strict=True))


def measure(contest: Contest) -> list[Record]:
    """Return medians of the steps, and of the call that consists of them."""
    rng = np.random.default_rng(4)
    rows = rng.uniform(contest.lower, contest.upper, (200, contest.lower.size))

    def other_work() -> None:
        ends = time.perf_counter() + BEHIND
        while time.perf_counter() < ends:
            contest.numpy.many(rows)

    records = []
    for windows in (WINDOWS, None):
        runs = []
        whole = []
        for _ in range(REPEATS):
            other_work()
            runs.append(once(contest, windows))
            other_work()
            began = time.perf_counter()
            jid.identify(contest.recording, contest.joint, windows=windows, search="ga")
            whole.append(time.perf_counter() - began)
        steps = {step: statistics.median(run[step] for run in runs) for step in STEPS}
        records.append({"kind": "anatomy", "whole": statistics.median(whole), "steps": steps})
    return records
