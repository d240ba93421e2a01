"""The present work of a page's process: its progress, the elapsed and the expected time."""

from __future__ import annotations

from jointid.base.pace import Pace

# [s] of a start and of each sample: only until work of the same name was measured on this machine.
_START = 0.5
_SAMPLE = {"identifying": 2e-5, "comparing": 4e-5}
_TRUSTED = 0.1  # the share from which the work's own pace says more than earlier work
_NEARLY = 0.95  # the largest share that is shown on the clock alone


class Work:
    """Work that runs, or none.

    Attributes
    ----------
    name : str
        What is done, e.g. "identifying"; "" where nothing is.
    share : float
        What is done of the whole, as the work reports it; 0 where it does not.
    step : str
        What is done now, as the work reports it.

    Examples
    --------
    >>> work = Work()
    >>> work.begin("identifying", samples=100_000)
    >>> work.text
    'identifying: 0 s of about 2 s'
    >>> work.progress(0.5, "generation 20 of 40")
    >>> work.shown_share
    0.5
    """

    def __init__(self) -> None:
        self.name, self.step, self.share = "", "", 0.0
        self._samples = 0
        self._pace = Pace()
        self._measured: dict[str, float] = {}  # [s] of a sample

    def begin(self, name: str, samples: int = 0) -> None:
        """Begin some work on a number of samples; 0 where it is not known."""
        self.name, self.step, self.share = name, "", 0.0
        self._samples, self._pace = samples, Pace()

    def progress(self, share: float, step: str) -> None:
        """Report how far the work is."""
        self.share, self.step = share, step

    def end(self, *, done: bool) -> None:
        """End it; work that is done says how long the next one of its name takes."""
        if done and self._samples:
            self._measured[self.name] = self._pace.elapsed / self._samples
        self.name = ""

    @property
    def expected(self) -> float | None:
        """The duration of the whole work [s]; None where nothing is known of it."""
        guess = None
        if self._samples and self.name in self._measured:
            guess = self._measured[self.name] * self._samples
        elif self._samples and self.name in _SAMPLE:
            guess = _START + _SAMPLE[self.name] * self._samples
        left = self._pace.left(self.share)
        if left is None or (self.share < _TRUSTED and guess is not None):
            return guess
        return self._pace.elapsed + left

    @property
    def shown_share(self) -> float:
        """The share as reported, otherwise by the clock."""
        expected = self.expected
        if self.share > 0.0 or not expected:
            return self.share
        return min(self._pace.elapsed / expected, _NEARLY)

    @property
    def text(self) -> str:
        """What is done, since when, and how long it may take; "" where nothing is."""
        if not self.name:
            return ""
        step = f", {self.step}" if self.step else ""
        elapsed, expected = self._pace.elapsed, self.expected
        if expected is None:
            return f"{self.name}{step}: {elapsed:.0f} s"
        if elapsed > expected:
            return (
                f"{self.name}{step}: {elapsed:.0f} s, longer than the expected {_seconds(expected)}"
            )
        return f"{self.name}{step}: {elapsed:.0f} s of about {_seconds(expected)}"


def _seconds(duration: float) -> str:
    return f"{max(duration, 1.0):.0f} s"
