"""Time of a session: the machine's monotonic clock, or the clock of an emulated bus."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from typing import Protocol

from jointid.base.errors import InputError


class Clock(Protocol):
    """Clock of a session."""

    def now(self) -> float:
        """Return the time [s] since an arbitrary start. It never decreases."""

    def sleep_until(self, deadline: float) -> None:
        """Return at the deadline [s], or at once if it has passed."""


class MonotonicClock:
    """Monotonic clock of the machine, with absolute deadlines.

    Without a real-time priority, a sleep ends 50 µs to some milliseconds late. Absolute deadlines keep these delays
    from adding up. For more exact deadlines, `spin` replaces the end of each sleep by a busy wait. A busy wait
    occupies a core and delays an emulator in the same process.

    Parameters
    ----------
    spin : float
        Duration of the busy wait at the end of each sleep [s]. Default 0.
    now, sleep : callable
        Functions that return the time [s] and that sleep for a time [s]; for tests. Default `time.perf_counter`,
        `time.sleep`.
    """

    def __init__(
        self,
        *,
        spin: float = 0.0,
        now: Callable[[], float] = time.perf_counter,
        sleep: Callable[[float], object] = time.sleep,
    ) -> None:
        if not 0.0 <= spin < math.inf:
            raise InputError("at least 0 s is expected", argument="spin", value=spin)
        self._spin, self._now, self._sleep = spin, now, sleep

    def now(self) -> float:
        """Return the time [s]."""
        return self._now()

    def sleep_until(self, deadline: float) -> None:
        """Sleep until shortly before the deadline, then wait in a loop until the deadline."""
        now, spin = self._now, self._spin
        while (left := deadline - now()) > spin:
            self._sleep(left - spin)
        while now() < deadline:
            pass
