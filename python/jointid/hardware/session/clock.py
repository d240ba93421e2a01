"""Time of a session: the machine's monotonic clock, or an emulated bus's own."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from typing import Protocol

from jointid.base.errors import InputError


class Clock(Protocol):
    """What a session needs of a clock."""

    def now(self) -> float:
        """Time [s] from an arbitrary start; never goes back."""

    def sleep_until(self, deadline: float) -> None:
        """Return at the deadline [s], or at once if it has passed."""


class MonotonicClock:
    """The machine's monotonic clock, waited for by absolute deadlines.

    A sleep ends late, by 50 µs to some milliseconds without a real-time priority. With deadlines that are
    absolute the delays do not add up; to meet them closer, sleep up to `spin` before and wait busily for
    the rest, at the price of a core and, in one process with an emulator, of its turns.

    Parameters
    ----------
    spin : float
        The end of each wait that is not slept [s]. Default 0.
    now, sleep : callable
        Where time comes from and how it is passed; for tests. Default `time.perf_counter`, `time.sleep`.
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
        """Time [s]."""
        return self._now()

    def sleep_until(self, deadline: float) -> None:
        """Sleep; what is left after one sleep is slept again, the last bit is waited busily."""
        now, spin = self._now, self._spin
        while (left := deadline - now()) > spin:
            self._sleep(left - spin)
        while now() < deadline:
            pass
