"""A session that records 1,000 rows a second while the power fails: not more than a second of it is lost."""

import ctypes
import os
import struct
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from threading import Timer

import numpy as np

import jointid as jid
from jointid.hardware.session.recorder import COLUMNS, Recorder

POWERLESS = 99  # exit code of a process whose power failed
_MISSING = 1.0  # [s]
_AT_ONCE = 16  # they wait most of the time
# Calls of more than two seconds. Before the first second nothing can be wrong, but files must be whole then, too.
_CALLS = 240
_MOMENTS = tuple(np.arange(0.3, 4.4, 0.1))
_FEW = (0.7, 1.3, 2.1, 3.4)


@dataclass(frozen=True)
class _End:
    """When the power fails: at a call, or at a moment [s]."""

    call: int = 0
    moment: float = 0.0

    def __str__(self) -> str:
        return f"call {self.call}" if self.call else f"after {self.moment:.1f} s"


def _record(folder: Path, acknowledge: Callable[[bytes], object]) -> None:
    """The moment of each row is acknowledged."""
    recorder = Recorder(folder / "run.csv", {"session": True})
    begin = time.monotonic()
    for number in range(10_000):
        left = begin + 1e-3 * number - time.monotonic()
        if left > 0.0:
            time.sleep(left)
        recorder.sample([number * 1e-3, *[0.25 * number] * (len(COLUMNS) - 1)])
        acknowledge(struct.pack("d", time.monotonic()))


def _judged(folder: Path, known: Sequence[float]) -> str:
    """By the clock: where others use the machine, many rows come at once."""
    path = folder / "run.csv"
    if not path.exists():  # while it was made
        return f"lost: all of {len(known)} rows" if known else ""
    rows = max(0, path.read_text().count("\n") - 2)
    if rows < len(known) and known[-1] - known[rows] > _MISSING:
        return f"lost: {known[-1] - known[rows]:.2f} s, {rows} of {len(known)} rows are left"
    return "" if rows < 8 or len(jid.load(path).time) == rows else "torn"


class _Session:
    """One that runs in a process of its own until its power fails."""

    def __init__(self, end: _End, library: ctypes.CDLL) -> None:
        self.end = end
        self._place = TemporaryDirectory()
        self._folder = Path(self._place.name).resolve() / "files"
        self._folder.mkdir()
        self._known = self._folder.with_name("known")
        self._child = os.fork()
        if self._child == 0:
            library.arm(os.fsencode(self._folder), ctypes.c_long(end.call), 0, 0)
            if end.moment:
                Timer(end.moment, library.lose).start()
            writing = os.open(self._known, os.O_WRONLY | os.O_CREAT, 0o600)
            _record(self._folder, partial(os.write, writing))
            os._exit(0)

    def wrong(self) -> str:
        """Wait for the end; what is wrong with what is left."""
        _, status = os.waitpid(self._child, 0)
        content = self._known.read_bytes() if self._known.exists() else b""
        known = [each[0] for each in struct.iter_unpack("d", content[: len(content) // 8 * 8])]
        said = _judged(self._folder, known)
        if os.waitstatus_to_exitcode(status) != POWERLESS:
            said = said or "the power did not fail"
        self._place.cleanup()
        return said and f"power at {self.end}: {said}"


def interrupted(library: ctypes.CDLL, *, all_of_them: bool) -> tuple[int, list[str]]:
    """How many sessions ended with a loss of power, some at a time, and what is wrong with what they left."""
    ends = [_End(moment=float(each)) for each in (_MOMENTS if all_of_them else _FEW)]
    ends += [_End(call=each) for each in range(1, _CALLS + 1, 1 if all_of_them else _CALLS // 3)]
    said = [session.wrong() for session in _at_once(ends, library)]
    return len(ends), [each for each in said if each]


def _at_once(ends: Sequence[_End], library: ctypes.CDLL) -> Iterator[_Session]:
    for begin in range(0, len(ends), _AT_ONCE):
        yield from [_Session(each, library) for each in ends[begin : begin + _AT_ONCE]]
