"""Accuracy for servos without a torque signal: simulated benches with known truth, and the logs of an XL330.

    python benchmarks/servo_study.py [--only logs] [--write]

`tests/simulated_servo.py` simulates the benches; each bench has new random parameters. The logs come from Rhoban BAM
(Apache-2.0) and are in tests/data. The peer is CMA-ES (pycma, dependency group `bench`) on rollouts of the same model
for the same training runs. The core computes these rollouts.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests"))

from measured import publish
from servo_benches import (
    BENCHES,
    BROKEN_BENCHES,
    FIRST_SEED,
    bench_table,
    broken_table,
)
from servo_logs import HELD_OUT, LOGS, REPEATS, TIMES, held_out_rows, time_rows


def main() -> None:
    """Run the study, or one part of it."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--only", choices=("benches", "broken", "logs"))
    parser.add_argument("--benches", type=int, default=100)
    parser.add_argument("--broken", type=int, default=20)
    parser.add_argument("--logs", type=Path, default=LOGS)
    parser.add_argument("--no-peer", action="store_true")
    parser.add_argument("--write", action="store_true", help="write it into the page, too")
    given = parser.parse_args()
    first = FIRST_SEED + given.benches
    if given.only in (None, "benches"):
        rows, warned = bench_table(range(FIRST_SEED, first))
        publish(BENCHES, rows, write=given.write, benches=given.benches, warned=warned)
    if given.only in (None, "broken"):
        broken = broken_table(range(first, first + given.broken))
        publish(BROKEN_BENCHES, broken, write=given.write, benches=given.broken)
    if given.only in (None, "logs"):
        held_out = held_out_rows(given.logs, peer=not given.no_peer)
        publish(HELD_OUT, held_out, write=given.write)
        publish(TIMES, time_rows(given.logs), write=given.write, repeats=REPEATS)


if __name__ == "__main__":
    main()
