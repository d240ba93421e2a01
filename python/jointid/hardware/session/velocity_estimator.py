"""Velocity estimate during a session, from positions in encoder counts."""

from __future__ import annotations

from collections import deque


class VelocityEstimator:
    """Position difference over the time in which at least some counts arrived (thesis, 6.3.1).

    Parameters
    ----------
    resolution : float
        Angle of an encoder count [rad].
    counts : int
        Smallest number of counts for a new estimate. Default 5.
    longest : float
        Longest time without a new estimate [s]. Default 0.01.
    """

    def __init__(self, resolution: float, counts: int = 5, longest: float = 0.01) -> None:
        self._travel = (counts - 0.5) * resolution
        self._longest = longest
        self._past: deque[tuple[float, float]] = deque()

    def __call__(self, time: float, position: float) -> float:
        """Return the velocity [rad/s] after one more position."""
        past = self._past
        past.append((time, position))
        while len(past) > 2 and (
            abs(position - past[1][1]) >= self._travel or time - past[0][0] > self._longest
        ):
            past.popleft()
        if len(past) < 2:
            return 0.0
        begin, there = past[0]
        return (position - there) / (time - begin)
