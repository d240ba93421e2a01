"""Whole arms: TX40 compared with the classical method, and simulated arms of seven joints.

python benchmarks/robot_study.py [--runs 20] [--log FOLDER OF tx40.csv.gz] [--only SECTION] [--write]
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path

from arms import late_torque, mismatches, seven_tables, speed_tables, tx40_tables
from measured import Part, publish

_LOG = Path(__file__).resolve().parents[1] / "tests" / "data" / "tx40"
Section = tuple[Part, Callable[[], Iterable[Sequence[object]]], int]


def sections(runs: int, hour: bool, log: Path) -> dict[str, Section]:
    """Return part, rows and number of arms of each section."""
    few, some = min(runs, 3), min(runs, 10)
    tables: dict[str, Section] = {
        "runs": (seven_tables.ARMS, lambda: seven_tables.accuracy(range(runs)), runs),
        "noise": (seven_tables.NOISY, lambda: seven_tables.noise(range(few)), few),
        "heavier": (seven_tables.HEAVIER, lambda: seven_tables.heavier(range(few)), few),
        "facts": (seven_tables.FACTS, lambda: seven_tables.wrong_facts(0), 1),
        "wrong": (mismatches.PART, lambda: mismatches.table(range(some)), some),
        "delays": (late_torque.PART, lambda: late_torque.delays(range(runs)), runs),
        "speed": (speed_tables.PART, lambda: speed_tables.tables(0, 5, hour), 1),
    }
    if not (log / "tx40.csv.gz").is_file():
        print(f"{log} holds no tx40.csv.gz: without the measured arm")
        return tables
    read = tx40_tables.Log.read(log)
    measured: dict[str, Section] = {
        "friction": (tx40_tables.FRICTION, lambda: tx40_tables.parameters(read), 1),
        "blocks": (tx40_tables.BLOCKS, lambda: tx40_tables.held_out(read), 1),
    }
    return measured | tables


def main() -> None:
    """Run the sections and publish their tables."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--runs", type=int, default=20, help="number of simulated arms")
    parser.add_argument("--hour", action="store_true", help="time an hour's recording, too")
    parser.add_argument(
        "--log", type=Path, default=_LOG, help="folder of tx40.csv.gz and tx40.urdf"
    )
    parser.add_argument("--only", default="", help="sections whose name contains this")
    parser.add_argument("--write", action="store_true", help="write them into the page, too")
    given = parser.parse_args()
    began = time.perf_counter()
    for name, (part, rows, arms) in sections(given.runs, given.hour, given.log).items():
        if given.only in name:
            publish(part, rows(), write=given.write, runs=arms)
    print(f"{time.perf_counter() - began:.0f} s")


if __name__ == "__main__":
    main()
