"""`make soak`: identify again and again; memory, threads and open files must not grow, results must not change."""

import argparse
import sys
import time
from pathlib import Path

import jointid as jid
from jointid.demo import data_folder


def resident() -> int:
    """Resident memory [bytes]."""
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return pages * 4096


def count(what: str) -> int:
    """Open entries of this process: threads ("task") or files ("fd")."""
    return len(list(Path(f"/proc/self/{what}").iterdir()))


def main(minutes: float) -> int:
    """Run; returns 1 when something leaks or a result changes."""
    recording = jid.load(data_folder() / "well_excited.csv.gz")
    options = jid.GaOptions(generations=20)
    first = jid.identify(recording, jid.thesis_joint(), ga=options).penalty
    for _ in range(20):  # allocators settle
        jid.identify(recording, jid.thesis_joint(), ga=options)
    before = resident(), count("task"), count("fd")
    ends = time.monotonic() + 60.0 * minutes
    rounds = changed = 0
    while time.monotonic() < ends:
        rounds += 1
        changed += jid.identify(recording, jid.thesis_joint(), ga=options).penalty != first
    after = resident(), count("task"), count("fd")
    grown = after[0] - before[0]
    print(
        f"{rounds} identifications: memory {grown / 1e6:+.1f} MB, threads {before[1]} -> {after[1]}, "
        f"files {before[2]} -> {after[2]}, changed results {changed}"
    )
    return int(grown > 20e6 or after[1:] != before[1:] or changed > 0)


if __name__ == "__main__":
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("--minutes", type=float, default=5.0)
    sys.exit(main(arguments.parse_args().minutes))
