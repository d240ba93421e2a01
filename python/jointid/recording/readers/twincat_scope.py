"""Text exports of TwinCAT Scope: a block of keys, then a time column for each group of channels."""

import re
from collections.abc import Mapping, Sequence
from functools import cached_property
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np
import numpy.typing as npt

from jointid.base.errors import InputError
from jointid.base.values import dataclass
from jointid.recording.headers import understood
from jointid.recording.order_statistics import median
from jointid.recording.readers.csv_dialect import number_of
from jointid.recording.readers.csv_text import Texts
from jointid.recording.readers.csv_torn import TORN
from jointid.recording.signals import FloatArray
from jointid.recording.stamps import Stamps, looks_exact, stamps_of
from jointid.recording.units import UNITS

_BLOCK = 80  # lines: exports have fewer lines above their rows
_KEYS = ("Data-Type", "SampleTime[ms]", "SymbolName", "VariableSize", "Starttime of export")
_TIME = r"Time(?: ?[\[(]ms[\])])?"  # newer versions: channel names in this line, no keys
# Signals that may be missing at the ends of a recording.
_OPTIONAL = ("temperature", "reference")
_COPY = r"(.*\S) \((\d+)\)"


@dataclass(frozen=True, kw_only=True)
class _Group:
    """Channels with one time column."""

    time: int  # 0-based number of its column
    channels: tuple[int, ...]


def separator_of_scope(lines: Sequence[str]) -> str | None:
    """Return the separator of an export of TwinCAT Scope; None for any other text."""
    block = lines[:_BLOCK]
    for key in _KEYS:
        for line in block:
            if not line.startswith(key):
                continue
            separator = line[len(key) : len(key) + 1]
            if separator and separator in "\t;,":
                named = any(each.startswith(f"Name{separator}") for each in block)
                return separator if named else None
    return None


class ScopeTable:
    """An export of TwinCAT Scope as a table with one time column.

    The samples of the fastest channel are the common instants, within the interval that all channels
    share. Channels with another period are interpolated linearly; `notes` names them and the number of
    samples cut. A temperature or reference never cuts samples: it keeps its last value for one period.
    If it is missing for longer, it cannot be read.

    Parameters
    ----------
    source : str
        The file.
    text : str
    separator : str
        Result of `separator_of_scope`.
    time : str
        Header of the time, with its unit.

    Raises
    ------
    InputError
        There are no rows, or cells are not numbers.
    """

    saved: Mapping[str, Any] | None = None

    def __init__(self, source: str, text: str, separator: str, time: str = "time [ms]") -> None:
        self.source = source
        self._texts, self._text = Texts(Path(source)), text
        self._texts.count(text)
        lines = text.replace("\r\n", "\n").replace("\r", "\n").split("\n")
        self._separator = separator
        keys: dict[str, list[str]] = {}
        name_line = first = -1
        block = lines[:_BLOCK]
        self._texts.count("", sum(line.count(separator) for line in block))
        for k, line in enumerate(block):
            cells = self._cells(line)
            if len(cells) > 1 and all(self._number(cell) is not None for cell in cells[:2]):
                first = k
                break
            if re.fullmatch(_TIME, cells[0]):
                cells = ["Name" if re.fullmatch(_TIME, cell) else cell for cell in cells]
            if cells[0]:
                keys[cells[0]] = cells
                name_line = k if cells[0] == "Name" else name_line
        if first < 0 or name_line < 0:
            raise InputError("the file has TwinCAT Scope's header, but no rows", place=source)
        self.header_place = f"{source}, line {name_line + 1}"
        self._first = first
        self._groups = _groups(keys["Name"])
        if not self._groups:
            raise InputError("TwinCAT Scope's header names no channel", place=self.header_place)
        self._of = {channel: group for group in self._groups for channel in group.channels}
        self._channels = tuple(self._of)
        self.headers = (time, *(_header(keys, k) for k in self._channels))
        symbols = keys.get("SymbolName", [])
        self.other_names: Mapping[str, int] = MappingProxyType(
            {
                symbols[k]: n
                for n, k in enumerate(self._channels, 1)
                if k < len(symbols) and symbols[k]
            }
        )
        self.notes: dict[str, Any] = {}
        self._rows = [line for line in lines[first:] if line.strip() and not line.startswith("EOF")]
        if len(self._rows) > 1 and not text.endswith("\n") and self._is_cut():
            del self._rows[-1]
            self.notes["incomplete"] = TORN
        self._table = self._plain()
        self._base: FloatArray | None = None

    def numbers(self, columns: Sequence[int]) -> list[FloatArray]:
        """Return columns as arrays of shape (n,), all at the same instants."""
        channels = [self._channels[column - 1] for column in columns if column > 0]
        groups = {self._of[channel].time: self._of[channel] for channel in channels}
        times = {time: self._samples(group)[0] for time, group in groups.items()}
        base = self._base
        if base is None:
            needed = {
                self._of[self._channels[column - 1]].time
                for column in columns
                if column > 0 and not self._is_optional(column)
            }
            every = {time: times[time] for time in times if time in needed or not needed}
            base = self._common(every or {g.time: self._samples(g)[0] for g in self._groups})
            if 0 in columns:
                self._base = base
        for column in columns:
            if column > 0 and self._is_optional(column):
                self._refuse_part(column, base)
        found = []
        for column in columns:
            if column == 0:
                found.append(base.copy())
                continue
            time, values = self._samples(self._of[self._channels[column - 1]], column)
            if len(time) != len(base) or not np.array_equal(time, base):
                if not np.isin(base, time).all():
                    period = f"{median(np.diff(time)):g} ms" if len(time) > 1 else "one sample"
                    self.notes.setdefault("interpolated", {})[self.headers[column]] = period
                values = np.interp(base, time, values) if len(time) else np.full(len(base), np.nan)
            found.append(values)
        return found

    def _common(self, every: Mapping[int, FloatArray]) -> FloatArray:
        """Return the instants of the fastest channel within the interval that all channels share."""
        fastest = min(every.values(), key=lambda t: median(np.diff(t)) if len(t) > 1 else np.inf)
        base = fastest
        for time in every.values():
            if len(time) and len(base):
                base = base[(base >= time[0]) & (base <= time[-1])]
        if len(base) < len(fastest):
            self.notes["cut_samples"] = len(fastest) - len(base)
        return base

    def _is_cut(self) -> bool:
        above, last = (row.count(self._separator) for row in self._rows[-2:])
        return last < above

    def _is_optional(self, column: int) -> bool:
        meaning = understood(self.headers[column]).meaning
        return meaning is not None and meaning.signal in _OPTIONAL

    def _refuse_part(self, column: int, base: FloatArray) -> None:
        """Raise for a channel that ends more than one period before the others, or begins that late."""
        time, _ = self._samples(self._of[self._channels[column - 1]])
        if not len(time) or not len(base):
            return
        period = median(np.diff(time)) if len(time) > 1 else 0.0
        if time[0] - period > base[0] or time[-1] + period < base[-1]:
            raise InputError(
                f"its samples reach from {time[0] / 1e3:.6g} to {time[-1] / 1e3:.6g} s, but the samples of the other "
                f"channels reach from {base[0] / 1e3:.6g} to {base[-1] / 1e3:.6g} s",
                place=f"{self.source}, channel {self.headers[column]!r}",
            )

    def text(self, column: int) -> list[str]:
        """Return the values of a column as text."""
        return [repr(value) for value in self.numbers([column])[0].tolist()]

    def place(self, column: int, row: int) -> str:
        """Return the place of a sample: file, channel and number."""
        return f"{self.source}, channel {self.headers[column]!r}, sample {row}"

    def _samples(self, group: _Group, column: int = 0) -> tuple[FloatArray, FloatArray]:
        """Return a group's time [ms] and one of its columns, without repeated samples."""
        index = self._channels[column - 1] if column else group.time
        if self._table is not None:
            time, values = self._table[:, group.time], self._table[:, index]
        else:
            long = np.flatnonzero(
                self._lengths > group.time
            )  # with many groups, few rows have cells of all of them
            cells = [row for row in map(self._all_cells.__getitem__, long) if row[group.time]]
            stamps = [row[group.time] for row in cells]
            values = self._column(cells, index)
            exact = _exact(stamps) if stamps and looks_exact(stamps[0]) else None
            time = self._column(cells, group.time) if exact is None else exact.seconds * 1000.0
        new = (
            np.concatenate([[True], np.diff(time) != 0.0]) if len(time) else np.zeros(0, dtype=bool)
        )
        return time[new], values[new]

    @cached_property
    def _all_cells(self) -> list[list[str]]:
        self._texts.count(self._text, self._text.count(self._separator))
        return [self._cells(row) for row in self._rows]

    @cached_property
    def _lengths(self) -> npt.NDArray[np.intp]:
        return np.fromiter(map(len, self._all_cells), dtype=np.intp, count=len(self._all_cells))

    def _column(self, rows: list[list[str]], index: int) -> FloatArray:
        found = [self._number(row[index] if index < len(row) else "") for row in rows]
        if None in found:
            row = found.index(None)
            cell = rows[row][index] if index < len(rows[row]) else ""
            raise InputError(
                f"{cell[:40]!r} is not a number" if cell else "the cell is empty",
                place=f"{self.source}, row {row + 1} below the header",
            )
        return np.array(found, dtype=np.float64)

    def _plain(self) -> FloatArray | None:
        """Return all rows if they are complete and hold only numbers; otherwise None."""
        if looks_exact(self._cells(self._rows[0])[0]):
            return None
        rows = self._rows
        if self._separator != "," and any("," in row for row in rows):
            if any("." in row for row in rows):
                return None
            rows = [row.replace(",", ".") for row in rows]
        try:
            table = np.loadtxt(rows, delimiter=self._separator, comments=None, ndmin=2)
        except ValueError:
            return None
        return table if table.shape[1] > max(self._channels) else None

    def _cells(self, line: str) -> list[str]:
        return [cell.strip().strip('"') for cell in line.split(self._separator)]

    def _number(self, cell: str) -> float | None:
        return number_of(cell, self._separator)


def _exact(stamps: Sequence[str]) -> Stamps | None:
    try:
        return stamps_of(stamps, None)
    except InputError:  # ambiguous numbers are in Scope's unit
        return stamps_of(stamps, UNITS["ms"])


def _groups(names: Sequence[str]) -> tuple[_Group, ...]:
    """Return the groups: each begins at a repetition of the key in the row of names."""
    starts = [k for k, cell in enumerate(names) if cell == "Name"]
    found = []
    for start, end in zip(starts, [*starts[1:], len(names)], strict=True):
        channels = tuple(k for k in range(start + 1, end) if names[k])
        if channels:
            found.append(_Group(time=start, channels=channels))
    return tuple(found)


def _header(keys: Mapping[str, list[str]], channel: int) -> str:
    """Return a channel's name, with its unit if the export states one for unscaled values."""

    def entry(key: str) -> str:
        cells = keys.get(key, [])
        return cells[channel] if channel < len(cells) else ""

    name = entry("Name")
    copied = re.fullmatch(_COPY, name)  # number of a channel that is drawn again; not a unit
    if copied:
        name = f"{copied[1]} copy {copied[2]}"
    unit = entry("Unit").strip("()[] ")
    scaled = entry("ScaleFactor").replace(",", ".") not in ("", "1", "1.0")
    return name if scaled or unit in ("", "None", "-") else f"{name} [{unit}]"
