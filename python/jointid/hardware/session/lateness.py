"""Late or lost samples and skipped cycles: the number that a session tolerates."""

from __future__ import annotations

from collections import deque

from jointid.hardware.session.limits import SessionLimits
from jointid.hardware.session.stop import LimitError

LOOKED_BACK = 5.0
"""Time over which `SessionLimits.late_share` is a share [s]."""


class Lateness:
    """Counter of cycles without their own sample, in a row and over the last 5 s.

    Parameters
    ----------
    limits : SessionLimits
    period : float
        Period of the cycles [s].
    """

    def __init__(self, limits: SessionLimits, period: float) -> None:
        self._limits = limits
        self._span = max(1, round(LOOKED_BACK / period))  # cycles
        # At a long period the share is less than one sample. The number allowed in a row is always allowed.
        self._most = max(limits.late_samples, limits.late_share * self._span)
        self._recent: deque[int] = deque()  # numbers of the late cycles of the last 5 s
        self._cycle = 0
        self.in_row = self.most_in_row = 0
        self.lost = self.skipped = 0  # in total

    def on_time(self) -> None:
        """Count a cycle with its sample."""
        self._cycle += 1
        self.in_row = 0

    def late(self, why: str) -> None:
        """Count a cycle without a sample in time.

        Raises
        ------
        LimitError
        """
        self.lost += 1
        self._count(why)

    def skip(self, cycles: int, late: float) -> None:
        """Count cycles that were skipped because the loop was late by `late` [s].

        Raises
        ------
        LimitError
        """
        self.skipped += cycles
        for _ in range(cycles):
            self._count(f"the loop was {1e3 * late:.1f} ms late and skipped {cycles} cycles")

    def _count(self, why: str) -> None:
        limits, recent = self._limits, self._recent
        self._cycle += 1
        self.in_row += 1
        self.most_in_row = max(self.most_in_row, self.in_row)
        recent.append(self._cycle)
        while recent[0] <= self._cycle - self._span:
            recent.popleft()
        if self.in_row > limits.late_samples:
            raise LimitError(
                "late_samples",
                f"{self.in_row} cycles in a row were without a sample in time, more than {limits.late_samples}: {why}",
                measured=self.in_row,
                allowed=limits.late_samples,
            )
        if len(recent) > self._most:
            raise LimitError(
                "late_share",
                f"{len(recent)} cycles of the last {LOOKED_BACK:g} s were without a sample in time, more than "
                f"{self._most:.4g} ({100.0 * limits.late_share:g} % of the cycles); the last late cycle: {why}",
                measured=len(recent) / self._span,
                allowed=limits.late_share,
            )
