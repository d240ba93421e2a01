"""The process that computes for a page."""

from __future__ import annotations

import asyncio
import os
import time
from collections.abc import Callable
from pathlib import Path

import pytest

import jointid as jid
from jointid.app.worker import CancelledWork, Worker


def doubled(report: Callable[[float, str], object], number: int) -> tuple[int, int]:
    report(0.5, "half")
    return 2 * number, os.getpid()


def refused(_report: object) -> None:
    raise jid.InputError("of no use", argument="number", value=3)


def faulty(_report: object) -> None:
    raise ZeroDivisionError("a bug")


def ended(_report: object) -> None:
    os._exit(9)


def endless(report: Callable[[float, str], object], mark: Path) -> None:
    mark.write_text(str(os.getpid()), encoding="utf-8")
    while True:
        time.sleep(0.01)


def test_calls_are_answered_by_one_other_process() -> None:
    told: list[tuple[float, str]] = []

    async def both() -> tuple[tuple[int, int], tuple[int, int]]:
        worker = Worker()
        first = await worker.run(doubled, 2, report=lambda share, text: told.append((share, text)))
        second = await worker.run(doubled, 3)
        worker.cancel()
        assert not worker.running
        return first, second

    first, second = asyncio.run(both())
    assert (first[0], second[0]) == (4, 6)
    assert first[1] == second[1] != os.getpid()
    assert told == [(0.5, "half")]


def test_errors_come_back_as_what_they_are_and_the_next_call_is_answered() -> None:
    async def calls() -> None:
        worker = Worker()
        with pytest.raises(jid.InputError, match="of no use") as found:
            await worker.run(refused)
        assert found.value.argument == "number"
        with pytest.raises(RuntimeError, match="ZeroDivisionError: a bug"):
            await worker.run(faulty)
        with pytest.raises(RuntimeError, match="the computation ended"):
            await worker.run(ended)
        assert (await worker.run(doubled, 4))[0] == 8
        worker.cancel()

    asyncio.run(calls())


def test_what_is_cancelled_ends_with_its_process(tmp_path: Path) -> None:
    mark = tmp_path / "process"

    async def calls() -> None:
        worker = Worker()
        task = asyncio.create_task(worker.run(endless, mark))
        waiting = asyncio.create_task(worker.run(doubled, 1))
        while not mark.exists() or not mark.read_text(encoding="utf-8"):
            await asyncio.sleep(0.01)
        worker.cancel()
        with pytest.raises(CancelledWork):
            await task
        with pytest.raises(CancelledWork):
            await waiting
        with pytest.raises(ProcessLookupError):
            os.kill(int(mark.read_text(encoding="utf-8")), 0)
        assert (await worker.run(doubled, 5))[0] == 10
        worker.cancel()

    asyncio.run(calls())
