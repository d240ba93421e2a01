"""The present work of a page's process: progress, elapsed time and expected time."""

from __future__ import annotations

from jointid.base.pace import Pace

# [s] for a start and for each sample, until work of the same name was measured on this machine.
_START = 0.5
_SAMPLE = {"identifying": 2e-5, "comparing": 4e-5}
_TRUSTED = 0.1  # share from which the present work's pace is more reliable than earlier work
_NEARLY = 0.95  # largest share that is shown from the clock alone


class Work:
    """The running work, or none.

    Attributes
    ----------
    name : str
        Name of the work, e.g. "identifying"; "" without work.
    share : float
        Finished share, as the work reports it; 0 without a report.
    step : str
        Present step, as the work reports it.

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
        self._measured: dict[str, float] = {}  # [s] per sample

    def begin(self, name: str, samples: int = 0) -> None:
        """Begin work on a number of samples; 0 if it is unknown."""
        self.name, self.step, self.share = name, "", 0.0
        self._samples, self._pace = samples, Pace()

    def progress(self, share: float, step: str) -> None:
        """Report the progress of the work."""
        self.share, self.step = share, step

    def end(self, *, done: bool) -> None:
        """End the work. Finished work gives the expected time of the next work of the same name."""
        if done and self._samples:
            self._measured[self.name] = self._pace.elapsed / self._samples
        self.name = ""

    @property
    def expected(self) -> float | None:
        """Expected duration of the whole work [s]; None if it is unknown."""
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
        """The reported share, otherwise the share from the clock."""
        expected = self.expected
        if self.share > 0.0 or not expected:
            return self.share
        return min(self._pace.elapsed / expected, _NEARLY)

    @property
    def text(self) -> str:
        """The work, its elapsed and its expected time; "" without work."""
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
