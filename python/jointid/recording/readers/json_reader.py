"""Reading .json files: records or rows under one or several keys, and the values next to them."""

import json
from collections.abc import Iterator, Mapping, Sequence
from itertools import pairwise
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np
import numpy.typing as npt

from jointid.base.error_text import reason_of
from jointid.base.errors import InputError
from jointid.recording.headers import understood
from jointid.recording.readers.csv_text import text_of
from jointid.recording.readers.reader import Reader
from jointid.recording.runs import shifts_of_runs
from jointid.recording.signals import FloatArray, signal_array

RUN = "run"
"""Header of the column that names the runs of a file with several."""
_TESTS = {"slow-forward", "slow-backward", "fast-forward", "fast-backward"}
# Columns of WPILib's SysId, which writes no names: for a mechanism, and for a drivetrain.
_ROWS: dict[int, tuple[str, ...]] = {
    4: ("time [s]", "voltage [V]", "position", "velocity"),
    9: (
        *("time [s]", "left.voltage [V]", "right.voltage [V]", "left.position", "right.position"),
        *("left.velocity", "right.velocity", "gyroscope [rad]", "gyroscope rate [rad/s]"),
    ),
}
# SysId writes rotations, and its units per rotation: SysId's unit → our unit, and units per rotation.
_UNITS: dict[object, tuple[str, float]] = {
    "Radians": ("rad", 1.0),
    "Degrees": ("deg", 1.0),
    "Rotations": ("rev", 1.0),
    "Meters": ("m", 1.0),
    "Feet": ("m", 0.3048),
    "Inches": ("m", 0.0254),
}
_LONGEST = 200  # characters of a text next to the rows
_Key = tuple[str | int, ...]


class JsonTable:
    """A .json file as a table of columns.

    The keys of records are columns; a list in a record gives one column per element. Rows under the names of SysId's
    tests have the columns that SysId documents. Several lists are consecutive runs, and the column `RUN` names them.
    Numbers and texts next to the rows are in `notes["stated"]`.

    Parameters
    ----------
    path : Path

    Raises
    ------
    InputError
        The file is not JSON, or holds no rows.
    """

    saved: Mapping[str, Any] | None = None
    other_names: Mapping[str, int] = MappingProxyType({})

    def __init__(self, path: Path) -> None:
        self.source = self.header_place = str(path)
        try:
            content = json.loads(text_of(path))
            lists, stated = dict(_lists(content)), dict(_stated(content))
        except (ValueError, RecursionError) as error:
            raise InputError(f"it is not JSON ({reason_of(error)})", place=self.source) from None
        runs = {name: rows for name, rows in lists.items() if rows}
        if not runs:
            raise InputError(
                "the file holds no rows; it must be a list of records, or hold one list of rows for each SysId test",
                place=self.source,
            )
        self._rows = [row for rows in runs.values() for row in rows]
        self._runs = [name for name, rows in runs.items() for _ in rows]
        self._factors: dict[str, float] = {}
        self._shift: FloatArray | None = None
        self._keys = _keys(self._rows)
        self.notes: dict[str, Any] = {"stated": stated} if stated else {}
        if _TESTS & set(runs):
            self._name_as_sysid(stated)
        self.headers = tuple(self._keys)
        if len(runs) > 1:
            self.headers += (RUN,)
            self.notes["runs"] = list(runs)
            self._put_in_order(np.cumsum([len(rows) for rows in runs.values()])[:-1])

    def numbers(self, columns: Sequence[int]) -> list[FloatArray]:
        """Return columns as arrays of shape (n,), or raise `InputError`."""
        return [self._numbers(column) for column in columns]

    def raw(self, column: int) -> npt.NDArray[Any] | None:
        """Return the values of a column as the file has them; None if they were converted."""
        if self._shift is not None or self.headers[column] in self._factors:
            return None
        return np.array(self._values(column), dtype=object)

    def text(self, column: int) -> list[str]:
        """Return the values of a column as text."""
        return list(map(str, self._values(column)))

    def first_cell(self, column: int) -> str:
        """Return the first value of a column as text."""
        return str(self._values(column)[0])

    def place(self, column: int, row: int) -> str:
        """Return the place of a value: file, 0-based row and column."""
        return f"{self.source}, row {row}, column {self.headers[column]!r}"

    def _values(self, column: int) -> list[Any]:
        if column == len(self._keys):
            return self._runs
        key = self._keys[self.headers[column]]
        return [_value(row, key) for row in self._rows]

    def _numbers(self, column: int) -> FloatArray:
        values, header = self._values(column), self.headers[column]
        if None in values:
            raise InputError(
                "the value is missing; a number is expected",
                place=self.place(column, values.index(None)),
            )
        cells = np.empty(len(values), dtype=object)
        cells[:] = values
        array = signal_array("", cells, f"{self.source}, column {header!r}")
        if self._shift is not None and header == self._time:
            return signal_array("", array + self._shift)
        return array if header not in self._factors else array * self._factors[header]

    def _name_as_sysid(self, stated: Mapping[str, Any]) -> None:
        """Name the columns of SysId's rows, and convert rotations to the stated unit."""
        names = _ROWS.get(len(self._keys) - (len(self._keys) == 10))
        if names is None:
            return
        unit, factor = _UNITS.get(stated.get("units"), ("", 1.0))
        per_rotation = stated.get("unitsPerRotation")
        self._keys = {}
        for index, name in enumerate(names):
            header = name
            if unit and per_rotation and "[" not in name:
                header += f" [{unit}/s]" if "velocity" in name else f" [{unit}]"
                self._factors[header] = factor * float(per_rotation)
            self._keys[header] = (index,)
        if self._factors:
            self.notes["converted"] = (
                f"position and velocity are converted: rotations times unitsPerRotation ({per_rotation:g})"
            )

    def _put_in_order(self, ends: npt.NDArray[np.int_]) -> None:
        """Sort runs by time; if they overlap, shift each run to begin after the previous one."""
        self._time = next((each for each in self._keys if _is_time(each)), "")
        try:
            time = self._numbers(self.headers.index(self._time))
        except (InputError, ValueError):  # there is no time, or its stamps are text
            return
        runs = np.split(np.arange(len(time)), ends)
        by_time = sorted(runs, key=lambda run: float(time[run[0]]))
        if all(time[first[-1]] < time[then[0]] for first, then in pairwise(by_time)):
            order = np.concatenate(by_time)
            self._rows = [self._rows[k] for k in order]
            self._runs = [self._runs[k] for k in order]
            return
        self._shift = shifts_of_runs(time, runs)


def _is_time(header: str) -> bool:
    meaning = understood(header).meaning
    return meaning is not None and meaning.signal == "time"


def _lists(content: Any, name: str = "") -> Iterator[tuple[str, list[Any]]]:
    """Yield the lists of records or rows; parallel lists of numbers are joined to rows."""
    if isinstance(content, list):
        if all(isinstance(each, dict | list) for each in content):
            yield name, content
    elif isinstance(content, dict):
        columns = {key: each for key, each in content.items() if _is_column(each)}
        lengths = set(map(len, columns.values()))
        if len(columns) > 1 and len(lengths) == 1:
            rows = zip(*columns.values(), strict=True)
            yield name, [dict(zip(columns, row, strict=True)) for row in rows]
        else:
            for key, each in content.items():
                yield from _lists(each, f"{name}.{key}" if name else key)


def _is_column(value: Any) -> bool:
    return (
        isinstance(value, list)
        and bool(value)
        and not any(isinstance(x, dict | list) for x in value)
    )


def _stated(content: Any, name: str = "") -> Iterator[tuple[str, str | float]]:
    """Yield the numbers and texts next to the rows."""
    if isinstance(content, dict):
        for key, value in content.items():
            yield from _stated(value, f"{name}.{key}" if name else key)
    elif name and isinstance(content, str | int | float) and len(str(content)) <= _LONGEST:
        yield name, content


def _keys(rows: list[Any]) -> dict[str, _Key]:
    """Return header → place of its value in a row, for all values of the rows."""
    found: dict[str, _Key] = {}
    seen: set[tuple[Any, ...]] = set()
    for row in rows:
        form = (type(row), *row) if isinstance(row, dict) else (type(row), len(row))
        if form not in seen:
            seen.add(form)
            for key in _inside(row):
                found.setdefault(_header(key), key)
    return found


def _inside(value: Any, key: _Key = ()) -> Iterator[_Key]:
    if isinstance(value, dict | list):
        parts = value.items() if isinstance(value, dict) else enumerate(value)
        for name, each in parts:
            yield from _inside(each, (*key, name))
    else:
        yield key


def _header(key: _Key) -> str:
    first, *rest = key
    header = f"column {first}" if isinstance(first, int) else first
    return header + "".join(f"_{k}" if isinstance(k, int) else f".{k}" for k in rest)


def _value(row: Any, key: _Key) -> Any:
    for part in key:
        try:
            row = row[part]
        except (KeyError, IndexError, TypeError):
            return None
    return row


READER = Reader(endings=(".json",), open=JsonTable)
