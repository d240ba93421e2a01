"""The contest's schedule: one seed of every peer in turn, so that a drift of the machine affects all equally."""

from __future__ import annotations

import gc
import statistics
import time

from peers.contest import Contest
from peers.peer import Peer, timed
from store import Store

SEEDS = 30
FEW = 7  # least number of runs for which a ratio is claimed
FAILED = 3  # runs after which a peer that never reached the target is dropped
LIMIT = 20.0  # [s] per run
SLOW = 2.0  # [s] per run; slower peers get only `FEW` runs
WARM = 0.05  # [s] of each peer before the first round: lazy imports, caches
HOPELESS = 10  # number of rows that are expected to use up their limit; they get half the time


def limit_for(seconds: float) -> float:
    """Return the wall-time limit of a run from the time for all."""
    return min(LIMIT, 0.5 * seconds / (FAILED * HOPELESS))


def run_contest(
    peers: list[Peer], contest: Contest, store: Store, *, seeds: int, seconds: float, limit: float
) -> None:
    """Run all rounds. The first `FAILED` always run, the others while time is left."""
    for peer in peers:
        timed(peer, contest, 0, WARM)
    # A collection before each run keeps one peer's garbage out of another's time. It must not visit all objects of the
    # libraries, because the caches would then be cold.
    gc.collect()
    gc.freeze()
    ends = time.perf_counter() + seconds
    for seed in range(seeds):
        for peer in peers:
            runs = store.of("run", peer=peer.key)
            if any(run["seed"] == seed for run in runs) or len(runs) >= _wanted(runs):
                continue
            if seed >= FAILED and time.perf_counter() > ends:
                return
            gc.collect()
            run = timed(peer, contest, seed, limit)
            store.append({"kind": "run", **run.asdict()})
        print(
            f"round {seed + 1} of {seeds} done, {ends - time.perf_counter():.0f} s left", flush=True
        )


def _wanted(runs: list[dict[str, float]]) -> int:
    """Return the number of runs that this peer should have, from its runs so far."""
    if len(runs) < FAILED:
        return FAILED
    if max(run["seconds"] for run in runs) < SLOW:
        return SEEDS
    if not any(run["reached"] for run in runs):
        return FAILED
    return FEW if statistics.median(run["seconds"] for run in runs) > SLOW else SEEDS
