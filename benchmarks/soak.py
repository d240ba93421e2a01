"""`make soak`: repeated identifications and sessions; nothing must grow, change or be lost."""

import argparse
import sys
import time

from recordings import WELL_EXCITED
from session_soak import count, resident, soak_sessions

import jointid as jid


def soak_identification(minutes: float) -> bool:
    """Identify the same recording for this time; return whether nothing leaks and no result changes."""
    recording = jid.load(WELL_EXCITED)
    options = jid.GaOptions(generations=20)
    first = jid.identify(recording, jid.thesis_joint(), search=jid.Search(ga=options)).penalty
    for _ in range(20):  # until the allocators are stable
        jid.identify(recording, jid.thesis_joint(), search=jid.Search(ga=options))
    before = resident(), count("task"), count("fd")
    ends = time.monotonic() + 60.0 * minutes
    rounds = changed = 0
    while time.monotonic() < ends:
        rounds += 1
        changed += (
            jid.identify(recording, jid.thesis_joint(), search=jid.Search(ga=options)).penalty
            != first
        )
    after = resident(), count("task"), count("fd")
    grown = after[0] - before[0]
    print(
        f"{rounds} identifications: memory {grown / 1e6:+.1f} MB, threads {before[1]} -> {after[1]}, "
        f"files {before[2]} -> {after[2]}, changed results {changed}"
    )
    return grown <= 20e6 and after[1:] == before[1:] and changed == 0


def main() -> int:
    """Run both; return 1 if something is not sound."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--minutes", type=float, default=5.0, help="of identification")
    parser.add_argument("--emulated-minutes", type=float, default=30.0, help="of sessions")
    arguments = parser.parse_args()
    sound = True
    if arguments.minutes > 0.0:
        sound = soak_identification(arguments.minutes)
    if arguments.emulated_minutes > 0.0:
        begin = time.monotonic()
        soaked = soak_sessions(arguments.emulated_minutes)
        took = time.monotonic() - begin
        print(f"{soaked}; {arguments.emulated_minutes:g} emulated minutes in {took:.0f} s")
        sound = sound and soaked.sound
    return int(not sound)


if __name__ == "__main__":
    sys.exit(main())
