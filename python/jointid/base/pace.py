"""Elapsed and remaining time of long work."""

from __future__ import annotations

import time


class Pace:
    """A clock that estimates the remaining time from the elapsed time.

    Examples
    --------
    >>> pace = Pace()
    >>> pace.left(0.0) is None
    True
    >>> pace.left(1.0)
    0.0
    """

    def __init__(self) -> None:
        self._began = time.monotonic()

    @property
    def elapsed(self) -> float:
        """Time since the work began [s]."""
        return time.monotonic() - self._began

    def left(self, share: float, resumed: float = 0.0) -> float | None:
        """Return the remaining time at the present pace [s]; None before any work is done.

        Parameters
        ----------
        share : float
            Share of the work that is done, 0 to 1.
        resumed : float
            Share that was done before this clock started. Default 0.
        """
        if share <= resumed:
            return None
        return self.elapsed * (1.0 - share) / (share - resumed)
