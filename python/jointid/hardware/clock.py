"""Time of a session: the machine's monotonic clock, or an emulated bus's own."""

from __future__ import annotations

import time
from typing import Protocol


class Clock(Protocol):
    """What a session needs of a clock."""

    def now(self) -> float:
        """Time [s] from an arbitrary start; never goes back."""

    def sleep_until(self, deadline: float) -> None:
        """Return at the deadline [s], or at once if it has passed."""


class MonotonicClock:
    """The machine's clock, waited for by absolute deadlines."""

    def now(self) -> float:
        """Time [s]."""
        return time.perf_counter()

    def sleep_until(self, deadline: float) -> None:
        """Sleep; what is left after one sleep is slept again."""
        while (left := deadline - time.perf_counter()) > 0.0:
            time.sleep(left)
