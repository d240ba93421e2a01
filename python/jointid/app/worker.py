"""The process that computes for a page. Long work can be cancelled, and ends with the page."""

from __future__ import annotations

import asyncio
import multiprocessing
import traceback
from collections.abc import Callable
from multiprocessing.connection import Connection
from typing import Any

from jointid.base.errors import InputError

_POLL = 0.02  # [s]


class CancelledWork(Exception):  # noqa: N818
    """The work was cancelled."""


class Worker:
    """A separate process that answers one call after the other.

    It starts with the first call. A call runs a function of this package. The function takes `report` (called
    with a share from 0 to 1 and a text) before its arguments. Its result must be picklable.
    """

    def __init__(self) -> None:
        self._process: Any = None
        self._connection: Connection | None = None
        self._lock = asyncio.Lock()
        self._generation = 0

    @property
    def running(self) -> bool:
        """Whether the process runs."""
        return self._process is not None and self._process.is_alive()

    async def run(
        self,
        function: Callable[..., Any],
        *arguments: Any,
        report: Callable[[float, str], object] = lambda _share, _text: None,
    ) -> Any:
        """Return the result of the function.

        Raises
        ------
        InputError
            The function raised it.
        CancelledWork
            `cancel` was called.
        RuntimeError
            The function failed with another error, or its process ended: a bug, or memory ran out.
        """
        generation = self._generation
        async with self._lock:
            if generation != self._generation:
                raise CancelledWork
            connection = self._started()
            connection.send((function, arguments))
            while True:
                # A cancelled call's connection is closed, so check the number first.
                while generation == self._generation and self.running and not connection.poll():
                    await asyncio.sleep(_POLL)
                if generation != self._generation:
                    raise CancelledWork
                try:
                    kind, content = connection.recv()
                except EOFError:
                    self.cancel()
                    raise RuntimeError(
                        "the computation ended: memory ran out, or the process was killed"
                    ) from None
                if kind == "progress":
                    report(*content)
                elif kind == "done":
                    return content
                elif kind == "refused":
                    raise content
                else:
                    raise RuntimeError(content)

    def cancel(self) -> None:
        """End the process and its computation. The next call starts another process."""
        self._generation += 1
        if self._process is not None:
            self._process.kill()
            self._process.join()
            self._process = None
        if self._connection is not None:
            self._connection.close()
            self._connection = None

    def _started(self) -> Connection:
        if not self.running or self._connection is None:
            context = multiprocessing.get_context("spawn")
            ours, theirs = context.Pipe()
            self._process = context.Process(target=_serve, args=(theirs,), daemon=True)
            self._process.start()
            theirs.close()
            self._connection = ours
        return self._connection


def _serve(connection: Connection) -> None:
    """Answer calls until the page is closed."""

    def report(share: float, text: str) -> None:
        connection.send(("progress", (share, text)))

    while True:
        try:
            function, arguments = connection.recv()
        except EOFError:
            return
        try:
            answer = ("done", function(report, *arguments))
        except InputError as error:
            answer = ("refused", error)
        except MemoryError:
            answer = ("refused", InputError("there is not enough memory for this recording"))
        except Exception:  # a bug: its traceback is more useful than a page that hangs
            answer = ("failed", traceback.format_exc())
        connection.send(answer)
