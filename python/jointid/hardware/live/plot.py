"""Plot of a session's signals while it runs, in a window of another process."""

from __future__ import annotations

import contextlib
import math
import os
import struct
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Self

from jointid.base.errors import InputError
from jointid.hardware.session.drive import DriveSample

POINT = struct.Struct("<5d")  # time, position, reference [rad], torque [N·m], reading
_SHORTEST = 0.02  # [s] between two points
_INTERVAL = 0.1  # [s] between two writes to the window


class LivePlot:
    """Window with position, reference, error, torque and sensor; the `observer` of a `Session`.

    Drawing with Matplotlib takes tens of milliseconds and would delay the control loop. Therefore another process
    draws. The control loop writes to a pipe ten times per second, at most 50 points per second, and never waits. If
    the pipe is full, points are dropped; `dropped` is their number. The window's process still needs processor time.

    Parameters
    ----------
    span : float
        Time span of the window [s]. Default 10.
    picture : path, optional
        File of the last picture, written on closing.
    window : bool
        Whether to show a window. Default True; False writes only the picture.
    now : callable
        Function that returns the time [s]; for tests. Default `time.monotonic`.

    Raises
    ------
    InputError
        The span is not above 0, or both window and picture are switched off.
    """

    def __init__(
        self,
        *,
        span: float = 10.0,
        picture: str | Path | None = None,
        window: bool = True,
        now: Callable[[], float] = time.monotonic,
    ) -> None:
        if not 0.0 < span < math.inf:
            raise InputError("more than 0 s is expected", argument="span", value=span)
        if picture is None and not window:
            raise InputError("LivePlot shows nothing without a window or a picture")
        self._now = now
        self._shift = self._before = 0.0
        self._phase = ""
        self._taken = self._written = -math.inf
        self._waiting = bytearray()
        self.dropped = 0
        command = [sys.executable, "-m", "jointid.hardware.live.window", f"--span={span}"]
        if picture is not None:
            command.append(f"--picture={Path(picture).absolute()}")
        if not window:
            command.append("--no-window")
        self._window = subprocess.Popen(command, stdin=subprocess.PIPE)
        assert self._window.stdin is not None
        self._pipe = self._window.stdin.fileno()
        os.set_blocking(self._pipe, False)

    def __call__(
        self, phase: str, when: float, sample: DriveSample, reference: float, torque: float
    ) -> None:
        """Take the values of a cycle."""
        if phase != self._phase and when < self._before - self._shift:
            self._shift = self._before  # each phase begins at 0, but the time axis continues
        self._phase = phase
        shown = when + self._shift
        self._before = max(self._before, shown)
        if shown - self._taken < _SHORTEST:
            return
        self._taken = shown
        self._waiting += POINT.pack(shown, sample.position, reference, torque, sample.reading)
        now = self._now()
        if now - self._written >= _INTERVAL:
            self._written = now
            self._write()

    def close(self) -> None:
        """Close the window after its picture is written to disk."""
        if self._window.stdin is None or self._window.stdin.closed:
            return
        os.set_blocking(self._pipe, True)
        self._write()
        with contextlib.suppress(BrokenPipeError):
            self._window.stdin.close()
        self._window.wait()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _write(self) -> None:
        """Write points to the pipe. It takes up to 4096 bytes completely or not at all; a closed window takes none."""
        while self._waiting:
            part = bytes(self._waiting[: 4096 // POINT.size * POINT.size])
            try:
                os.write(self._pipe, part)
            except (BlockingIOError, BrokenPipeError):
                self.dropped += len(self._waiting) // POINT.size
                self._waiting.clear()
                return
            del self._waiting[: len(part)]
