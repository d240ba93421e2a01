"""Execution of a study's work: in this process, or in an executor."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Executor, Future, wait

from jointid.study.row import Row
from jointid.study.runner import Runner, run_chunk
from jointid.study.work import Place, Work

_OUTSTANDING = 64  # largest number of chunks in an executor at a time
_LONGEST_WAIT = 0.05  # [s] between two checks for Ctrl-C


def finished_rows(
    work: Work, places: Sequence[Place], executor: Executor | None
) -> Iterator[list[Row]]:
    """Yield the rows of trials as they finish.

    Parameters
    ----------
    work : Work
    places : sequence of Place
        Trials to run.
    executor : Executor or None
        None: this process.
    """
    if executor is None:
        runner = Runner(work)
        for chunk in work.chunks(places):
            yield from runner.run(chunk)
        return
    yield from _elsewhere(work, places, executor)


def _elsewhere(work: Work, places: Iterable[Place], executor: Executor) -> Iterator[list[Row]]:
    chunks = work.chunks(list(places))
    running: set[Future[list[Row]]] = set()
    try:
        while True:
            while len(running) < _OUTSTANDING and (chunk := next(chunks, None)) is not None:
                running.add(executor.submit(run_chunk, work, chunk))
            if not running:
                return
            finished = wait(running, timeout=_LONGEST_WAIT, return_when=FIRST_COMPLETED).done
            running -= finished
            for future in finished:
                yield future.result()
    finally:
        for future in running:
            future.cancel()
