"""Progress bars on the terminal for long work."""

from __future__ import annotations

import sys
import time
from types import TracebackType
from typing import TYPE_CHECKING, Self, TextIO

from jointid._core import GaOptions, Generation
from jointid.base.error_text import joint_phrase
from jointid.base.pace import Pace

if TYPE_CHECKING:
    from jointid.comparison.fitter import ComparisonStep
    from jointid.excitation.design_search import DesignProgress
    from jointid.study.sweeping import StudyStep

_WIDTH = 24
_PERIOD = 0.1  # [s] between two drawings


class _Bar:
    """Bar on a terminal; it shows nothing elsewhere."""

    def __init__(self, *, enabled: bool = True, stream: TextIO | None = None) -> None:
        self._stream = stream if stream is not None else sys.stderr
        self._enabled = enabled and self._stream.isatty()
        self._drawn = 0.0
        self._pace = Pace()

    def _draw(self, share: float, text: str, resumed: float = 0.0) -> None:
        """Draw at most ten times per second. `resumed` is the share that was done in an earlier run."""
        now = time.monotonic()
        if not self._enabled or now - self._drawn < _PERIOD:
            return
        from jointid.cli.terminal import columns_of

        self._drawn = now
        left = self._pace.left(share, resumed)
        if left is not None:
            text = f"about {left:.0f} s left, {text}"
        full = round(_WIDTH * min(1.0, share))
        line = f"{'█' * full}{'·' * (_WIDTH - full)} {text}"
        # A line that wraps could not be overwritten.
        self._stream.write(f"\r{line[: (columns_of(self._stream) or len(line) + 1) - 1]}\033[K")
        self._stream.flush()

    def __enter__(self) -> Self:
        """Draw nothing yet."""
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


class Progress(_Bar):
    """Callback for `identify` that draws a bar on a terminal, and nothing elsewhere.

    Parameters
    ----------
    total : int, optional
        Largest number of generations. Default: that of the default options.
    enabled : bool
    stream : text file, optional
        Default: standard error.
    """

    def __init__(
        self, *, total: int | None = None, enabled: bool = True, stream: TextIO | None = None
    ) -> None:
        super().__init__(enabled=enabled, stream=stream)
        self._total = total or GaOptions().generations

    def __call__(self, generation: Generation) -> None:
        """Show a generation."""
        self._draw(
            generation.number / self._total,
            f"generation {generation.number}/{self._total}, best penalty {generation.best:.6g}",
        )


class JointsProgress(_Bar):
    """Callback for `identify_joints` that shows the current joint.

    Parameters
    ----------
    enabled : bool
    stream : text file, optional
        Default: standard error.
    """

    def __call__(self, joint: str, number: int, count: int) -> None:
        """Show a joint."""
        self._draw(number / count, f"{joint_phrase(joint)}, {number + 1} of {count}")


class ComparisonProgress(_Bar):
    """Callback for `compare_models` that draws a bar on a terminal, and nothing elsewhere.

    Parameters
    ----------
    enabled : bool
    stream : text file, optional
        Default: standard error.
    """

    def __call__(self, step: ComparisonStep) -> None:
        """Show a fit."""
        self._draw(step.number / step.total, f"fit {step.number}/{step.total}, {step.model}")


class MotionProgress(_Bar):
    """Callback for `design_excitation` that draws a bar on a terminal, and nothing elsewhere.

    Parameters
    ----------
    enabled : bool
    stream : text file, optional
        Default: standard error.
    """

    def __call__(self, step: DesignProgress) -> None:
        """Show the number of tried motions."""
        self._draw(
            step.number / step.total,
            f"motion {step.number}/{step.total}, error {100.0 * step.best:.2g} %",
        )


class StudyProgress(_Bar):
    """Callback for `sweep` that draws a bar on a terminal, and nothing elsewhere.

    Parameters
    ----------
    enabled : bool
    stream : text file, optional
        Default: standard error.
    """

    def __init__(self, *, enabled: bool = True, stream: TextIO | None = None) -> None:
        super().__init__(enabled=enabled, stream=stream)
        self._first: int | None = None

    def __call__(self, step: StudyStep) -> None:
        """Show the finished trials."""
        if self._first is None:
            self._first = step.number - len(step.rows)
        text = f"trial {step.number}/{step.total}"
        self._draw(step.number / step.total, text, self._first / step.total)
