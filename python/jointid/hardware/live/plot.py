"""A session's signals drawn while it runs, in a window of another interpreter."""

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
    """Position and reference, error, torque and sensor in a window; a `Session`'s observer.

    Drawing takes matplotlib tens of milliseconds, in which a thread of this interpreter would hold up the
    motor's loop. So another interpreter draws, and the loop hands 50 points a second at most to a pipe, ten
    times a second, without ever waiting: points that a slow window has no room for are left out of the
    picture (and counted in `dropped`). What is left is that the window's process wants a processor, too.

    Parameters
    ----------
    span : float
        Of time in the window [s]. Default 10.
    picture : path, optional
        Where the last picture goes, on closing.
    window : bool
        False: no window, only the picture. Default True.
    now : callable
        Where time comes from [s]; for tests. Default `time.monotonic`.

    Raises
    ------
    InputError
        The span is not more than 0, or there is neither window nor picture.
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
            raise InputError("LivePlot: neither a window nor a picture; nothing would be seen")
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
        """Take a cycle's values."""
        if phase != self._phase and when < self._before - self._shift:
            self._shift = self._before  # each phase begins at 0; the picture goes on
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
        """End the window; its picture is on disk when this returns."""
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
        """A pipe takes up to 4096 bytes whole or not at all; a window that was closed takes nothing."""
        while self._waiting:
            part = bytes(self._waiting[: 4096 // POINT.size * POINT.size])
            try:
                os.write(self._pipe, part)
            except (BlockingIOError, BrokenPipeError):
                self.dropped += len(self._waiting) // POINT.size
                self._waiting.clear()
                return
            del self._waiting[: len(part)]
