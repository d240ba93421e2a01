"""Display of a session while it runs: a line on the console, and several observers at once."""

from __future__ import annotations

import math
import queue
import threading
import time
from collections.abc import Callable
from typing import Self, TextIO

from jointid.hardware.session.drive import DriveSample

Observer = Callable[[str, float, DriveSample, float, float], object]
_SHORTEST = 0.1  # [s] between two lines


class ConsoleLine:
    """Status line of a session, updated at most ten times per second; the `observer` of a `Session`.

    On a terminal the line is overwritten. In a file, a line is written at the start of each phase and then once per
    second. A thread writes the line, so a blocked terminal does not delay the control loop. Call `close`, or use the
    object as a context manager, so that the last line is written.

    Parameters
    ----------
    stream : text stream
        E.g. `sys.stderr`.
    now : callable
        Function that returns the time [s]; for tests. Default `time.monotonic`.
    """

    def __init__(self, stream: TextIO, *, now: Callable[[], float] = time.monotonic) -> None:
        self._stream, self._now = stream, now
        self._terminal = stream.isatty()
        self._interval = _SHORTEST if self._terminal else 1.0
        self._due, self._phase = -math.inf, ""
        self._last: tuple[str, float, DriveSample, float, float] | None = None
        self._lines: queue.SimpleQueue[str | None] = queue.SimpleQueue()
        self._thread = threading.Thread(target=self._write, name="console line", daemon=True)
        self._thread.start()

    def __call__(
        self, phase: str, when: float, sample: DriveSample, reference: float, torque: float
    ) -> None:
        """Take the values of a cycle."""
        self._last = (phase, when, sample, reference, torque)
        now = self._now()
        # A new phase is shown at once only if this causes no flicker.
        new_phase = phase != self._phase and not self._terminal
        if now >= self._due or new_phase:
            self._due, self._phase, self._last = now + self._interval, phase, None
            self._lines.put(console_line(phase, when, sample, reference, torque))

    def close(self) -> None:
        """Write the last line if it is not written yet."""
        if not self._thread.is_alive():
            return
        if self._last is not None:
            self._lines.put(console_line(*self._last))
        self._lines.put(None)
        self._thread.join()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _write(self) -> None:
        drawn = 0
        try:
            while (line := self._lines.get()) is not None:
                while (
                    self._terminal and not self._lines.empty()
                ):  # only the newest values are drawn
                    following = self._lines.get()
                    if following is None:
                        self._lines.put(None)
                        break
                    line = following
                if self._terminal:
                    self._stream.write("\r" + line.ljust(drawn))
                    drawn = len(line)
                else:
                    self._stream.write(line + "\n")
                self._stream.flush()
            if self._terminal and drawn:
                self._stream.write("\n")
                self._stream.flush()
        except (OSError, ValueError):
            return  # a closed console is no reason to stop a motor


class Observers:
    """Several observers as one. `close` closes those that have a method `close`.

    Parameters
    ----------
    observers : callable
    """

    def __init__(self, *observers: Observer) -> None:
        self._observers = observers

    def __call__(
        self, phase: str, when: float, sample: DriveSample, reference: float, torque: float
    ) -> None:
        """Call all observers."""
        for observer in self._observers:
            observer(phase, when, sample, reference, torque)

    def close(self) -> None:
        """Close all observers, even if some raise."""
        failures: list[Exception] = []
        for observer in self._observers:
            close = getattr(observer, "close", None)
            try:
                if close is not None:
                    close()
            except Exception as error:
                failures.append(error)
        if failures:
            raise failures[0]

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


def console_line(
    phase: str, when: float, sample: DriveSample, reference: float, torque: float
) -> str:
    """Return the line of a cycle: phase, time [s], position and its error [°], torque [N·m], sensor."""
    error = math.degrees(sample.position - reference)
    sensor = "clipped" if sample.clipped else f"{sample.reading:7.1f}"
    return (
        f"{phase:<6} {when:7.2f} s  position {math.degrees(sample.position):8.3f}°  "
        f"error {error:+8.4f}°  torque {torque:+8.2f} N·m  sensor {sensor}"
    )
