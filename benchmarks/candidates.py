"""Time per candidate of each form of the penalty, alone and in a population; medians, interleaved."""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable

import numpy as np
from peers.contest import Contest
from store import Record

from jointid import _core

POPULATION = 200
REPEATS = 11
LEAST = 0.02  # [s] per measurement
COMPRESSED = f"compressed, {POPULATION} per call, one thread"
THESIS = "`thesis()` search 200 × 1500, one thread, whole search"
THESIS_CODE = "`thesis_code()` search 200 × 1500, one thread, whole search"


def measure(contest: Contest) -> list[Record]:
    """Return seconds per candidate: rows of name and median."""
    rng = np.random.default_rng(1)
    rows = rng.uniform(contest.lower, contest.upper, (POPULATION, contest.lower.size))
    full = np.asfortranarray(np.array([contest.full(row) for row in rows]).T)
    one, one_full = rows[0], full[:, 0].copy()
    big = np.asfortranarray(np.tile(full, 100))
    direct = contest.direct
    compressed = _core.CompressedPenalty(direct, contest.full_lower, contest.full_upper)

    def by_population(form: _core.PenaltyFunction, threads: int) -> Callable[[], object]:
        return lambda: form.evaluate(full, threads=threads)

    def preset(options: _core.GaOptions) -> Callable[[], object]:
        whole = options.replace(population=200, generations=1500)
        return lambda: _core.minimise_genetic(
            compressed, contest.full_lower, contest.full_upper, options=whole, threads=1
        )

    what: dict[str, tuple[Callable[[], object], int]] = {
        "NumPy, one candidate per call": (lambda: contest.numpy(one), 1),
        f"NumPy, {POPULATION} per call": (lambda: contest.numpy.many(rows), POPULATION),
        "compiled direct sum, one per call": (lambda: direct(one_full), 1),
        f"compiled direct sum, {POPULATION} per call, one thread": (
            by_population(direct, 1),
            POPULATION,
        ),
        f"compiled direct sum, {POPULATION} per call, all threads": (
            by_population(direct, 0),
            POPULATION,
        ),
        "compressed, one per call from Python": (lambda: compressed(one_full), 1),
        COMPRESSED: (by_population(compressed, 1), POPULATION),
        "compressed, 20 000 per call, one thread": (
            lambda: compressed.evaluate(big, threads=1),
            100 * POPULATION,
        ),
        THESIS: (preset(_core.GaOptions.thesis()), 200 * 1501),
        THESIS_CODE: (preset(_core.GaOptions.thesis_code()), 200 * 1501),
        "compression (once per identification)": (
            lambda: _core.CompressedPenalty(direct, contest.full_lower, contest.full_upper),
            1,
        ),
    }
    seconds: dict[str, list[float]] = {name: [] for name in what}
    for _ in range(REPEATS):
        for name, (call, count) in what.items():
            calls, began = 0, time.perf_counter()
            while (spent := time.perf_counter() - began) < LEAST or calls == 0:
                call()
                calls += 1
            seconds[name].append(spent / calls / count)
    return [
        {"kind": "candidate", "name": name, "seconds": statistics.median(values)}
        for name, values in seconds.items()
    ]
