"""A progress bar on the terminal for long searches."""

from __future__ import annotations

import sys
import time
from types import TracebackType
from typing import TextIO

from jointid._core import GaOptions, Generation

_WIDTH = 24
_PERIOD = 0.1  # [s] between two drawings


class Progress:
    """A callback for `identify` that draws a bar on a terminal, and nothing elsewhere.

    Parameters
    ----------
    total : int, optional
        Generations at most; default: those of the default options.
    enabled : bool
    stream : text file, optional
        Default: standard error.
    """

    def __init__(
        self, *, total: int | None = None, enabled: bool = True, stream: TextIO | None = None
    ) -> None:
        self._total = total or GaOptions().generations
        self._stream = stream if stream is not None else sys.stderr
        self._enabled = enabled and self._stream.isatty()
        self._drawn = 0.0

    def __call__(self, generation: Generation) -> None:
        """Draw, at most ten times a second."""
        now = time.monotonic()
        if not self._enabled or now - self._drawn < _PERIOD:
            return
        self._drawn = now
        share = min(1.0, generation.number / self._total)
        bar = "█" * round(_WIDTH * share) + "·" * (_WIDTH - round(_WIDTH * share))
        text = f"\r{bar} generation {generation.number}/{self._total}, best penalty {generation.best:.6g} "
        self._stream.write(text)
        self._stream.flush()

    def __enter__(self) -> Progress:
        """Nothing yet."""
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """Clear the line."""
        if self._enabled and self._drawn:
            self._stream.write("\r\033[K")
            self._stream.flush()
