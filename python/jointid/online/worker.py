"""The thread that processes samples, and the data shared with the caller's thread."""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from jointid.base.errors import InputError
from jointid.online.online_estimate import OnlineEstimate
from jointid.online.settings import OnlineSettings
from jointid.online.sliding import Sliding

Array = NDArray[np.float64]


class Worker:
    """Accepts samples, processes them on a separate thread, and keeps the latest estimate.

    It has no reference to its identifier. Therefore the thread also ends if the identifier is
    garbage-collected without `close`.
    """

    def __init__(
        self, settings: OnlineSettings, callback: Callable[[OnlineEstimate], object] | None
    ) -> None:
        self._settings = settings
        self._callback = callback
        self._condition = threading.Condition()  # re-entrant: a finalizer may stop it
        self._waiting: deque[dict[str, Array]] = deque()
        self._dropped = 0
        self._busy = False
        self._closed = False
        self._failure: BaseException | None = None
        self._estimate: OnlineEstimate | None = None
        self.thread: threading.Thread | None = None

    def put(self, samples: dict[str, Array]) -> None:
        """Add samples to the queue; samples older than a window are dropped."""
        with self._condition:
            self._raise_failure()
            if self._closed:
                raise InputError("the identifier is closed", place="feed")
            self._waiting.append(samples)
            last = samples["time"][-1]
            while (
                len(self._waiting) > 1
                and last - self._waiting[0]["time"][0] > self._settings.window
            ):
                self._dropped += self._waiting.popleft()["time"].size
            if self.thread is None:
                self.thread = threading.Thread(
                    target=self._work, args=(tuple(samples),), name="jointid on-line", daemon=True
                )
                self.thread.start()
            self._condition.notify_all()

    def latest(self) -> OnlineEstimate | None:
        """Return the latest estimate, or raise a pending failure."""
        with self._condition:
            self._raise_failure()
            return self._estimate

    def wait(self, timeout: float | None) -> OnlineEstimate | None:
        """Wait until all samples are processed, and return the latest estimate."""
        if self.thread is threading.current_thread():
            raise InputError(
                "the callback runs on this thread, so it cannot wait for this thread", place="wait"
            )
        with self._condition:
            done = self._condition.wait_for(
                lambda: self._failure is not None or (not self._waiting and not self._busy), timeout
            )
            self._raise_failure()
            if not done:
                raise TimeoutError(f"the samples were not processed within {timeout} s")
            return self._estimate

    def stop(self) -> None:
        """End the thread after the present piece."""
        with self._condition:
            self._closed = True
            self._waiting.clear()
            self._condition.notify_all()

    def join(self) -> None:
        """Wait for the end of the thread, except on the thread itself."""
        if self.thread is not None and self.thread is not threading.current_thread():
            self.thread.join()

    def raise_failure(self) -> None:
        """Raise a pending failure."""
        with self._condition:
            self._raise_failure()

    def _raise_failure(self) -> None:
        failure, self._failure = self._failure, None
        if failure is not None:
            raise failure

    def _work(self, signals: tuple[str, ...]) -> None:
        sliding = self._sliding(signals)
        while True:
            with self._condition:
                self._condition.wait_for(lambda: self._closed or bool(self._waiting))
                if self._closed:
                    return
                taken = list(self._waiting)
                self._waiting.clear()
                self._busy = True
                dropped = self._dropped
            try:
                sliding = self._digest(sliding, taken, dropped) or self._sliding(signals)
            finally:
                with self._condition:
                    self._busy = False
                    self._condition.notify_all()

    def _sliding(self, signals: tuple[str, ...]) -> Sliding:
        return Sliding(self._settings, signals, lambda: self._closed)

    def _digest(
        self, sliding: Sliding, taken: list[dict[str, Array]], dropped: int
    ) -> Sliding | None:
        """Process samples and return a new estimate; None after an error, because the samples may be its cause."""
        try:
            for samples in taken:
                sliding.append(samples)
            found = sliding.estimate(dropped)
        except BaseException as error:  # raised by the next call
            with self._condition:
                self._failure = error
            return None
        if found is not None:
            with self._condition:
                self._estimate = found
            self._call_back(found)
        return sliding

    def _call_back(self, found: OnlineEstimate) -> None:
        if self._callback is None:
            return
        try:
            self._callback(found)
        except BaseException as error:  # from the user's callback, raised by the next call
            with self._condition:
                self._failure = error
