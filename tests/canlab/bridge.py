"""A bridge between two vcans, in the guest: the host's and the drive's, with frames lost or late on the way."""

from __future__ import annotations

import heapq
import time
from collections.abc import Callable

import can

from canlab.programs import Program
from canlab.stage import Stage

POSITION = 0x4FF


def bridged(stage: Stage, delay: Callable[[int], float | None]) -> None:
    """Put a bridge between the stage's channel and another, on which the drive is.

    Parameters
    ----------
    stage : Stage
    delay : callable
        For the number of an answer to a SYNC how long it is held back [s], None if it is lost.
    """
    there = stage.another_channel()
    ready = stage.folder / "bridge.ready"

    def run() -> int:
        with (
            can.Bus(stage.channel, interface="socketcan") as host,
            can.Bus(there, interface="socketcan") as drive,
        ):
            ready.touch()
            _carry(host, drive, delay)
        return 0

    stage.programs.append(Program("bridge", stage.folder, run))
    stage.emulator(channel=there)
    stage.until(ready.exists, "the bridge does not begin")


def _carry(host: can.BusABC, drive: can.BusABC, delay: Callable[[int], float | None]) -> None:
    """Carry frames until the process is ended; in the order of their times, as on one wire."""
    waiting: list[tuple[float, int, can.Message]] = []
    answers = count = 0
    while True:
        due = waiting[0][0] - time.monotonic() if waiting else 1.0
        ready = _readable((host, drive), max(0.0, due))
        if host in ready and (message := host.recv(0.0)) is not None:
            drive.send(message)
        if drive in ready and (message := drive.recv(0.0)) is not None:
            wait: float | None = 0.0
            if message.arbitration_id == POSITION:
                answers += 1
                wait = delay(answers)
            if wait is not None:
                count += 1
                heapq.heappush(waiting, (time.monotonic() + wait, count, message))
        while waiting and waiting[0][0] <= time.monotonic():
            host.send(heapq.heappop(waiting)[2])


def _readable(buses: tuple[can.BusABC, ...], timeout: float) -> list[can.BusABC]:
    import select

    return select.select(buses, [], [], timeout)[0]
