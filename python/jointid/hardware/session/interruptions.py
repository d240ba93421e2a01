"""Request to stop by Ctrl-C, SIGTERM or a closed terminal. It takes effect between two cycles."""

from __future__ import annotations

import signal
import threading
from types import FrameType, TracebackType
from typing import Any

_PATIENCE = 3  # number of Ctrl-C after which an exception leaves a drive that does not answer


class Interruptions:
    """Context that catches SIGINT, SIGTERM, SIGHUP and SIGQUIT as a request to stop, on the main thread.

    On other threads Python delivers no signals, and nothing is caught.
    """

    def __init__(self) -> None:
        self.reason: str | None = None
        self._count = 0
        self._before: dict[int, Any] = {}

    def __enter__(self) -> Interruptions:
        if threading.current_thread() is threading.main_thread():
            for name in (
                "SIGINT",
                "SIGTERM",
                "SIGHUP",
                "SIGQUIT",
            ):  # the last two do not exist on every platform
                number = getattr(signal, name, None)
                if number is not None:
                    self._before[number] = signal.signal(number, self._caught)
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        for number, before in self._before.items():
            # None: the handler was not installed by Python and cannot be restored.
            signal.signal(number, signal.SIG_DFL if before is None else before)

    def _caught(self, number: int, frame: FrameType | None) -> None:
        del frame
        self.reason = self.reason or f"stopped by {signal.Signals(number).name}"
        self._count += 1
        if self._count >= _PATIENCE:
            raise KeyboardInterrupt
