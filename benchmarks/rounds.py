"""The contest's schedule: one seed of every peer in turn, so that a drift of the machine hits all alike."""

from __future__ import annotations

import gc
import statistics
import time

from peers.contest import Contest
from peers.peer import Peer, timed
from store import Store

SEEDS = 30
FEW = 7  # the least a ratio is claimed of
FAILED = 3  # runs after which a peer that never reached the target is left alone
LIMIT = 20.0  # [s] a run
SLOW = 2.0  # [s] a run, beyond which `FEW` must do
WARM = 0.05  # [s] of each peer before the first round: lazy imports, caches
HOPELESS = 10  # rows expected to use up their limit; they get half the time


def limit_for(seconds: float) -> float:
    """Wall-time limit of a run, when so much time is there for all."""
    return min(LIMIT, 0.5 * seconds / (FAILED * HOPELESS))


def run_contest(
    peers: list[Peer], contest: Contest, store: Store, *, seeds: int, seconds: float, limit: float
) -> None:
    """All rounds. The first `FAILED` are run whatever they take, the others while time is left."""
    for peer in peers:
        timed(peer, contest, 0, WARM)
    # A collection before each run keeps one peer's garbage off another's clock. It must not walk over all that the
    # libraries have loaded: behind that the caches are cold, which nobody's run is to blame for.
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
    """Runs that this peer is to have, by those that it has had."""
    if len(runs) < FAILED:
        return FAILED
    if max(run["seconds"] for run in runs) < SLOW:
        return SEEDS
    if not any(run["reached"] for run in runs):
        return FAILED
    return FEW if statistics.median(run["seconds"] for run in runs) > SLOW else SEEDS
