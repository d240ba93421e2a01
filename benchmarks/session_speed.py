"""Share of a cycle that a session itself takes on the virtual clock, without the bus and its devices.

    python benchmarks/session_speed.py [--seconds 20] [--rounds 5]

A cycle begins when the wait for it ends and ends when the next wait begins; the time inside the bus's `send`
and `recv`, where python-can and the emulated devices work, is subtracted. The quietest of several rounds counts.
"""

import argparse
import statistics
import tempfile
import time
from pathlib import Path
from typing import Any

import can
from session_rig import devices, run

from jointid.hardware.emulated.bus import EmulatedBus


class TimedBus(EmulatedBus):
    """Records the time outside of each cycle."""

    def __init__(self, *devices: Any) -> None:
        self.cycles: list[float] = []
        self._inside = 0.0
        self._began: float | None = None
        super().__init__(*devices)

    def send(self, msg: can.Message, timeout: float | None = None) -> None:
        """Send a frame, timed."""
        begin = time.perf_counter()
        super().send(msg, timeout)
        self._inside += time.perf_counter() - begin

    def recv(self, timeout: float | None = None) -> can.Message | None:
        """Receive a frame, timed."""
        begin = time.perf_counter()
        message = super().recv(timeout)
        self._inside += time.perf_counter() - begin
        return message

    def sleep_until(self, deadline: float) -> None:
        """End a cycle and begin the next."""
        if self._began is not None:
            self.cycles.append(time.perf_counter() - self._began - self._inside)
        super().sleep_until(deadline)
        self._inside = 0.0
        self._began = time.perf_counter()


def own_times(seconds: float, output: Path | None = None) -> list[float]:
    """Return the session's own time in each cycle of a run [s]."""
    bus = TimedBus(*devices())
    run(bus, seconds, output)
    return bus.cycles


def figures(cycles: list[float]) -> tuple[float, float, float]:
    """Return median, 99th percentile and mean [µs]."""
    percentiles = statistics.quantiles(cycles, n=100)
    return 1e6 * statistics.median(cycles), 1e6 * percentiles[98], 1e6 * statistics.fmean(cycles)


def main() -> None:
    """Run and print a table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seconds", type=float, default=20.0)
    parser.add_argument("--rounds", type=int, default=5)
    arguments = parser.parse_args()
    print("| own time of a cycle | median (µs) | 99 % (µs) | mean (µs) |")
    print("|---|---|---|---|")
    for name, kept in (("in memory", False), ("with the recording and frames on disk", True)):
        rounds = []
        for _ in range(arguments.rounds):
            with tempfile.TemporaryDirectory() as folder:
                output = Path(folder) / "run.csv" if kept else None
                rounds.append(figures(own_times(arguments.seconds, output)))
        quietest = [min(each) for each in zip(*rounds, strict=True)]
        print(f"| {name} | " + " | ".join(f"{value:.0f}" for value in quietest) + " |")


if __name__ == "__main__":
    main()
