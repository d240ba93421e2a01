"""The pace of work that takes long: how much time has passed, and how much is left."""

from __future__ import annotations

import time


class Pace:
    """The time since work began, from which the rest is estimated.

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
        """Return how long the rest takes at the pace so far [s]; None before any of it is done.

        Parameters
        ----------
        share : float
            What is done of the whole, from 0 to 1.
        resumed : float
            The share that was done before the work began. Default 0.
        """
        if share <= resumed:
            return None
        return self.elapsed * (1.0 - share) / (share - resumed)
