"""What the guest runs: the scenarios that are named, and kills by their numbers, one after the other."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from pathlib import Path

from canlab.kills import killed
from canlab.programs import Program
from canlab.scenarios import SCENARIOS
from canlab.stage import Stage, play

OUT = Path("/run/out")
LONGEST = 300.0  # [s] that a scenario may take


def main(names: list[str]) -> int:
    """Play what is named; each in a process of its own, on a vcan of its own."""
    _load()
    for number, name in enumerate(names):
        begin = time.monotonic()
        act = killed(int(name)) if name.isdecimal() else SCENARIOS[name].act
        Program(name, OUT, _playing(OUT / name, f"vcan{number}", act)).wait(LONGEST)
        print(f"{name}: {time.monotonic() - begin:.1f} s", flush=True)
    return 0


def _playing(folder: Path, channel: str, act: Callable[[Stage], None]) -> Callable[[], int]:
    def run() -> int:
        play(folder, channel, act)
        return 0

    return run


def _load() -> None:
    """Load what the programs need, once for all of them."""
    import can.interfaces.socketcan

    import jointid.cli.commands
    from jointid.hardware import Bench, Session, open_drive

    del can, jointid, Bench, Session, open_drive


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
