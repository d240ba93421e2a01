"""What the guest runs: the scenarios that are named, and kills by their numbers, one after the other."""

from __future__ import annotations

import gc
import sys
import time
from pathlib import Path

from canlab.kills import killed
from canlab.scenarios import SCENARIOS
from canlab.stage import play

OUT = Path("/run/out")


def main(names: list[str]) -> int:
    """Play what is named, each on a vcan of its own."""
    _load()
    for number, name in enumerate(names):
        begin = time.monotonic()
        act = killed(int(name)) if name.isdecimal() else SCENARIOS[name].act
        play(OUT / name, f"vcan{number}", act)
        sys.stdout.write(f"{name}: {time.monotonic() - begin:.1f} s\n")
        sys.stdout.flush()
    return 0


def _load() -> None:
    """Load what the programs need, once for all of them."""
    import can.interfaces.socketcan

    import jointid.cli.commands
    from jointid.hardware import Bench, Session, open_drive

    del can, jointid, Bench, Session, open_drive
    gc.freeze()  # a collection in a forked program would copy every page, which takes a guest long


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
