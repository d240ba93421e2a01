"""`make bench`: times to the optimum on one recording and one penalty; writes its parts of the page.

Results first go to build/bench as JSON lines, so that an interrupted run continues where it stopped.
"""

from __future__ import annotations

import argparse
import time
import warnings
from pathlib import Path

import anatomy
import candidates
import interruption
import literal_code
import model_costs
import performance
import scaling
from peers.contest import make_contest
from peers.table import all_peers
from rounds import SEEDS, limit_for, run_contest
from store import Store

ROOT = Path(__file__).resolve().parents[1]
WORK = ROOT / "build" / "bench"
ASIDE = 5.0  # minutes of the budget for scaling and the rest
QUICK_LARGEST = 600_000  # samples


def main(*, budget: float, quick: bool) -> None:
    """Run everything."""
    warnings.filterwarnings("ignore")  # the libraries' own
    began = time.perf_counter()
    seeds = 3 if quick else SEEDS
    seconds = 60.0 * max(budget - ASIDE, 0.5 * budget)
    limit = limit_for(seconds)
    settings = {"budget": budget, "quick": quick, "limit": limit, **performance.versions()}
    store = Store(WORK / ("quick.jsonl" if quick else "full.jsonl"), settings)
    contest = make_contest()
    run_contest(all_peers(), contest, store, seeds=seeds, seconds=seconds, limit=limit)
    if not store.of("candidate"):
        for record in candidates.measure(contest):
            store.append(record)
    if not store.of("model"):
        for record in model_costs.measure(contest):
            store.append(record)
    if not store.of("literal"):
        store.append(literal_code.measure(contest.recording, WORK, 2 if quick else 7))
    if not store.of("anatomy"):
        for record in anatomy.measure(contest):
            store.append(record)
    if not store.of("online"):
        store.append(scaling.online())
    if not store.of("interruption"):
        store.append(interruption.interrupted(QUICK_LARGEST if quick else interruption.SAMPLES))
    scaling.measure(contest, store, QUICK_LARGEST if quick else max(scaling.SAMPLES))
    order = [peer.key for peer in all_peers()]
    performance.publish_all(store, order, limit, write=not quick)
    store.append({"kind": "finished"})
    print(f"{(time.perf_counter() - began) / 60:.1f} minutes")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--budget", type=float, default=20.0, help="minutes for all (default 20)")
    parser.add_argument(
        "--quick",
        action="store_true",
        help="three seeds, two minutes, to try it out: writes no page",
    )
    given = parser.parse_args()
    main(budget=2.0 if given.quick else given.budget, quick=given.quick)
