"""What the guest runs: scenarios, several at once, each a process with a vcan of its own."""

from __future__ import annotations

import sys
import time
from collections import deque
from collections.abc import Callable
from pathlib import Path

from canlab.programs import Program
from canlab.scenarios import SCENARIOS
from canlab.stage import Stage, play

OUT = Path("/run/out")
_AT_ONCE = 1


def main(names: list[str]) -> int:
    """Play what is named."""
    _load()
    waiting = deque((name, SCENARIOS[name].act) for name in names)
    count = len(waiting)
    running: list[Program] = []
    while waiting or running:
        running = [program for program in running if program.ended() is None]
        if waiting and len(running) < _AT_ONCE:
            number = count - len(waiting)
            running.append(_playing(*waiting.popleft(), f"vcan{number}"))
        else:
            time.sleep(0.02)
    return 0


def _playing(name: str, act: Callable[[Stage], None], channel: str) -> Program:
    def run() -> int:
        begin = time.monotonic()
        play(OUT / name, channel, act)
        print(f"{name}: {time.monotonic() - begin:.1f} s", file=sys.stderr)
        return 0

    return Program(f"play.{name}", OUT, run)


def _load() -> None:
    """Load what the programs need, once for all of them."""
    import can.interfaces.socketcan

    import jointid.cli.commands
    from jointid.hardware import Bench, Session, open_drive

    del can, jointid, Bench, Session, open_drive


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
