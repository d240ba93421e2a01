"""What the guest runs: the scenarios that are named, or kills, side by side."""

from __future__ import annotations

import sys
import time
from pathlib import Path

from canlab.scenarios import SCENARIOS
from canlab.stage import play

_AT_ONCE = 1

OUT = Path("/run/out")


def main(names: list[str]) -> int:
    for number, name in enumerate(names):
        t = time.monotonic()
        play(OUT / name, f"vcan{number}", SCENARIOS[name])
        print(name, time.monotonic() - t)
    return 0


if __name__ == "__main__":
    print("begin", time.monotonic(), flush=True)
    sys.exit(main(sys.argv[1:]))
