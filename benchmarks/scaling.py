"""Growth of time and memory: samples, windows, population. Medians of few runs, each a record."""

from __future__ import annotations

import json
import statistics
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path

import numpy as np
from peers.contest import Contest, problem_of
from store import Record, Store

import jointid as jid
from jointid import _core

SAMPLES = (6_000, 60_000, 600_000, 3_600_000, 6_000_000)
WINDOWS = (10, 100, 1000, 6000)
POPULATIONS = (20, 200, 2000, 20000)
GENERATIONS = 20
REPEATS = 7
HERE = Path(__file__).resolve().parent


def median(call: Callable[[], object], repeats: int = REPEATS) -> float:
    """Return seconds per call."""
    seconds = []
    for _ in range(repeats):
        began = time.perf_counter()
        call()
        seconds.append(time.perf_counter() - began)
    return statistics.median(seconds)


def by_samples(largest: int) -> Iterator[Record]:
    """Time whole `identify` calls on recordings of 6 s to 100 minutes, with the peak of memory."""
    for samples in SAMPLES:
        if samples > largest:
            return
        repeats = REPEATS if samples <= 3_600_000 else 3
        yield {"over": "samples", **_child("long_recording.py", str(samples), str(repeats))}


def online() -> Record:
    """Time the online identifier's updates."""
    return {"kind": "online", **_child("online_updates.py")}


def _child(program: str, *arguments: str) -> Record:
    """Return the output of a program of this folder, run in its own process."""
    call = [sys.executable, str(HERE / program), *arguments]
    printed = subprocess.run(call, check=True, text=True, capture_output=True).stdout
    record: Record = json.loads(printed)
    return record


def by_windows(contest: Contest) -> Iterator[Record]:
    """Time whole `identify` calls, and the compressed penalty per candidate."""
    rng = np.random.default_rng(2)
    free = rng.uniform(contest.lower, contest.upper, (2000, contest.lower.size))
    rows = np.asfortranarray(np.array([contest.full(row) for row in free]).T)
    for windows in WINDOWS:
        _, direct = problem_of(contest.recording, contest.joint, windows)
        form = _core.CompressedPenalty(direct, contest.full_lower, contest.full_upper)
        yield {
            "over": "windows",
            "windows": windows,
            "seconds": median(
                partial(jid.identify, contest.recording, contest.joint, windows=windows)
            ),
            "candidate": median(partial(form.evaluate, rows, threads=1)) / len(free),
        }


def by_population(contest: Contest) -> Iterator[Record]:
    """Time the genetic search on the compressed penalty, one thread."""
    low, high = contest.full_lower, contest.full_upper
    form = _core.CompressedPenalty(contest.direct, low, high)
    for population in POPULATIONS:
        options = _core.GaOptions(
            population=population, generations=GENERATIONS, polish=False, tolerance=0.0
        )
        seconds = median(
            partial(_core.minimise_genetic, form, low, high, options=options, threads=1)
        )
        candidates = population * (GENERATIONS + 1)
        yield {
            "over": "population",
            "population": population,
            "seconds": seconds,
            "candidate": seconds / candidates,
        }


def measure(contest: Contest, store: Store, largest: int) -> None:
    """Measure everything that the store does not have yet."""
    parts: dict[str, Callable[[], Iterator[Record]]] = {
        "samples": lambda: by_samples(largest),
        "windows": lambda: by_windows(contest),
        "population": lambda: by_population(contest),
    }
    for over, part in parts.items():
        if store.of("scaling", over=over):
            continue
        for record in list(part()):
            store.append({"kind": "scaling", **record})
        print(f"scaling over {over} done", flush=True)
