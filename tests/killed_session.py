"""A session in a program of its own that keeps the machine's time and is killed by its parent.

Run with the path of the recording. Each row's number and the time [ns] at which it was handed to the
recorder go to the standard output.
"""

import os
import sys
import time
from collections.abc import Sequence
from pathlib import Path

from session_bench import devices, session

from jointid.hardware.emulated.bus import EmulatedBus
from jointid.hardware.session.recorder import Recorder

DURATION = 8.0  # [s]


class PacedBus(EmulatedBus):
    """A virtual clock that does not run ahead of the machine's."""

    def sleep_until(self, deadline: float) -> None:
        """As on virtual time, but wait."""
        super().sleep_until(deadline)
        time.sleep(max(0.0, self.now() - (time.perf_counter() - BEGAN)))


class Told:
    """Says what the recorder was given."""

    rows = 0

    def __call__(self, recorder: Recorder, row: Sequence[float]) -> None:
        """Keep and tell it."""
        SAMPLE(recorder, row)
        self.rows += 1
        os.write(1, f"{self.rows} {time.monotonic_ns()}\n".encode())


if __name__ == "__main__":
    BEGAN, SAMPLE, TOLD = time.perf_counter(), Recorder.sample, Told()
    Recorder.sample = lambda recorder, row: TOLD(recorder, row)  # type: ignore[assignment,method-assign]
    with PacedBus(*devices(seed=5)) as bus:
        session(bus, DURATION, output=Path(sys.argv[1])).run()
