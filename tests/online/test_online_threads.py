"""Samples from several threads: each block is taken once and as a whole, or refused."""

import sys
import threading
from collections.abc import Iterator

import numpy as np
import pytest

import jointid as jid

_THREADS, _BLOCKS, _SIZE = 4, 50, 20


@pytest.fixture
def hasty() -> Iterator[None]:
    """Threads that take turns all the time."""
    before = sys.getswitchinterval()
    sys.setswitchinterval(1e-6)
    yield
    sys.setswitchinterval(before)


def test_a_block_is_taken_once(hasty: None) -> None:
    """Every thread feeds the same blocks: of each block one is taken, and what was taken is in order."""
    identifier = jid.OnlineIdentifier(jid.thesis_joint(), window=1000.0)
    taken: list[np.ndarray] = []
    put = identifier._worker.put

    def slow(samples: dict[str, np.ndarray]) -> None:
        taken.append(samples["time"])
        threading.Event().wait(1e-4)  # another thread has its turn between check and put
        put(samples)

    identifier._worker.put = slow  # type: ignore[method-assign]
    refused: list[str] = []
    other: list[BaseException] = []

    def feed() -> None:
        for block in range(_BLOCKS):
            time = (block * _SIZE + np.arange(_SIZE)) * 1e-3
            try:
                identifier.feed(time=time, position=np.sin(time), torque=time, sensor=time)
            except jid.InputError as error:
                refused.append(str(error))
            except BaseException as error:
                other.append(error)

    threads = [threading.Thread(target=feed) for _ in range(_THREADS)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    identifier.close()
    assert not other
    assert all("time must increase" in each for each in refused)
    assert len(taken) == len({times[0] for times in taken})
    assert len(taken) + len(refused) == _THREADS * _BLOCKS
    assert bool(np.all(np.diff(np.concatenate(taken)) > 0.0))
