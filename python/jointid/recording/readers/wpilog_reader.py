"""Reading .wpilog files, which WPILib's robots write, with wpiutil; the extra `wpilib` installs it."""

import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np

from jointid.base.error_text import reason_of
from jointid.base.errors import InputError
from jointid.recording.headers import understood
from jointid.recording.readers.reader import Reader
from jointid.recording.signals import FloatArray, signal_array
from jointid.recording.units import find_unit

_NUMBERS = {
    "double": "getDouble",
    "float": "getFloat",
    "int64": "getInteger",
    "boolean": "getBoolean",
}
_SYSID = re.compile(r"(position|velocity|voltage|acceleration|current)-(.+)")
_STATE = "sysid-test-state"  # prefix of the entry that names the running test
_IDLE = "none"
_SPELLED = {"volt": "V", "volts": "V", "ampere": "A", "amp": "A", "amps": "A"}
_Samples = tuple[list[int], list[Any]]  # stamps [us] and values


class WpilogTable:
    """A .wpilog file as a table: its numeric entries at the instants of the position.

    Each entry has its own stamps from the same loop; entries are interpolated linearly. If SysId names its tests,
    rows between tests are left out, and the column "run" names the test.

    Parameters
    ----------
    path : Path

    Raises
    ------
    InputError
        The file is not such a log, is damaged, or has no numbers.
    ModuleNotFoundError
        wpiutil is not installed.
    """

    saved: Mapping[str, Any] | None = None
    other_names: Mapping[str, int] = MappingProxyType({})

    def __init__(self, path: Path) -> None:
        import wpiutil.log

        self.source = self.header_place = str(path)
        path.open("rb").close()  # WPILib's reader does not report why it cannot open a file
        reader = wpiutil.log.DataLogReader(str(path))
        if not reader.isValid():
            raise InputError("the file is not a .wpilog file, or is truncated", place=self.source)
        try:
            entries = _entries(reader)
        except (RuntimeError, ValueError, TypeError) as error:
            raise InputError(
                f"the file is damaged ({reason_of(error)})", place=self.source
            ) from None
        state = next((each for name, each in entries.items() if name.startswith(_STATE)), None)
        self._channels = {
            name: each
            for name, each in entries.items()
            if each[0] and not isinstance(each[1][0], str)
        }
        if not self._channels:
            raise InputError("the file has no entries of numbers", place=self.source)
        positions = [name for name in self._channels if _names_position(name)]
        stamps = np.unique(self._channels[(positions or list(self._channels))[0]][0])
        runs = _held(state, stamps) if state is not None else []
        if set(runs) - {_IDLE}:
            kept = [k for k, run in enumerate(runs) if run != _IDLE]
            stamps, runs = stamps[kept], [runs[k] for k in kept]
        else:
            runs = []
        self._stamps, self._runs = stamps, runs
        self.headers = ("time [s]", *self._channels, *(["run"] if runs else []))

    def numbers(self, columns: Sequence[int]) -> list[FloatArray]:
        """Return columns as arrays of shape (n,), or raise `InputError`."""
        return [self._numbers(column) for column in columns]

    def text(self, column: int) -> list[str]:
        """Return the values of a column as text."""
        if self._runs and column == len(self.headers) - 1:
            return self._runs
        return list(map(repr, self._numbers(column).tolist()))

    def place(self, column: int, row: int) -> str:
        """Return the place of a value: file, time of the row, and entry."""
        return f"{self.source}, at {self._stamps[row] / 1e6:.6f} s, entry {self.headers[column]!r}"

    def _numbers(self, column: int) -> FloatArray:
        if column == 0:
            return signal_array("", (self._stamps - self._stamps[0]) / 1e6)
        if self._runs and column == len(self.headers) - 1:
            raise InputError(
                "this entry holds the names of runs; numbers are expected", place=self.source
            )
        stamps, values = self._channels[self.headers[column]]
        times, first = np.unique(stamps, return_index=True)
        return np.interp(self._stamps, times, np.array(values, dtype=np.float64)[first])


def _entries(reader: Any) -> dict[str, _Samples]:
    """Return header → entry of numbers or texts."""
    found: dict[str, _Samples] = {}
    read: dict[int, tuple[str, str]] = {}  # entry → header and reading method
    for record in reader:
        if record.isStart():
            start = record.getStartData()
            method = "getString" if start.type == "string" else _NUMBERS.get(start.type)
            if method:
                read[start.entry] = (_header(start.name, start.metadata), method)
        elif not record.isControl() and record.getEntry() in read:
            header, method = read[record.getEntry()]
            stamps, values = found.setdefault(header, ([], []))
            values.append(getattr(record, method)())
            stamps.append(record.getTimestamp())
    return found


def _header(name: str, metadata: str) -> str:
    """Return ``elbow.position [rev]`` for SysId's ``position-elbow`` with rotations in its metadata."""
    signal = _SYSID.fullmatch(name)
    shown = f"{signal[2]}.{signal[1]}" if signal else name
    word, _, per = metadata.strip('" ').lower().partition(" per ")
    unit = find_unit(_SPELLED.get(word, word))
    if per and unit is not None:
        unit = find_unit(f"{unit.name}_s") if per.startswith("second") else None
    return shown if unit is None else f"{shown} [{unit.name}]"


def _names_position(header: str) -> bool:
    meaning = understood(header).meaning
    return meaning is not None and meaning.signal == "position"


def _held(samples: _Samples, stamps: Any) -> list[str]:
    """Return the last text before each instant; empty before the first text."""
    times, texts = samples
    places = np.searchsorted(times, stamps, side="right") - 1
    return [str(texts[k]) if k >= 0 else _IDLE for k in places.tolist()]


READER = Reader(
    endings=(".wpilog",), open=WpilogTable, package="wpiutil", install="robotpy-wpiutil"
)
