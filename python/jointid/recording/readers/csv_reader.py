"""Reading .csv and .csv.gz files: the core parses plain numbers, numpy the others; errors name the cell."""

import csv
import re
import shlex
from collections.abc import Mapping, Sequence
from functools import cached_property
from itertools import islice
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np

from jointid import _core
from jointid.base.errors import InputError
from jointid.recording.damaged_rows import RepeatedHeaderError
from jointid.recording.readers.column_pairs import Paired, paired_columns
from jointid.recording.readers.csv_dialect import (
    BLANK,
    cells_of,
    decimal_comma,
    number_of,
)
from jointid.recording.readers.csv_layout import SEARCHED, is_comment, layout_of
from jointid.recording.readers.csv_stream import each_line, even_rows, plain_numbers
from jointid.recording.readers.csv_text import Texts, text_of
from jointid.recording.readers.csv_torn import TORN, without_torn_line
from jointid.recording.readers.list_columns import list_of
from jointid.recording.readers.reader import Reader
from jointid.recording.readers.twincat_scope import ScopeTable, separator_of_scope
from jointid.recording.saved import CSV_MARK, saved_attributes
from jointid.recording.signals import FloatArray
from jointid.recording.table import Table
from jointid.recording.truncated import no_sample, session_text, with_metadata

_LONG = 1 << 20  # characters: a longer file of numbers only is read as a stream
_BEGINS_AT_ONCE = re.compile(r"[^\s#%/]").match  # a line that is certainly not a comment
_SHORT = 1 << 15  # characters: most tables begin within this length
_FEW = 12  # columns: in wider tables only used columns are converted
_INNER = "\x1f"  # separator for joined cells; no text file contains it


class CsvTable:
    """A .csv or .csv.gz file as a table of columns with one header.

    Commas, semicolons, tabs or blanks separate the cells. If commas do not, they may be the decimal sign.
    Comments begin with ``#``, ``%`` or ``//``; if numbers follow without a header, the last comment may be
    the header. Without a header the headers are ``"column 0"``, ``"column 1"``, ...

    Parameters
    ----------
    path : Path
    text : str
        Content of the file, if it was read before. Default: the file is read.

    Raises
    ------
    InputError
        The file cannot be read or is not text, or it has no rows or rows of different lengths.
    """

    other_names: Mapping[str, int] = MappingProxyType({})

    def __init__(self, path: Path, text: str = "") -> None:
        self.source = str(path)
        self._texts = Texts(path)
        self._content = text or text_of(path)
        ending: Mapping[str, Any] | None = None  # last line of a session's file
        if self._content.startswith(CSV_MARK):
            self._content, ending = session_text(self._content)
        self._table: FloatArray | None = None
        long = len(self._content) > _LONG
        try:
            lines = _first_lines(self._content)
        except InputError as error:
            raise error.at(self.source) from None
        self.saved: Mapping[str, Any] | None = None
        if lines[0].startswith(CSV_MARK):
            self.saved = saved_attributes(lines[0][len(CSV_MARK) :], f"{self.source}, line 1")
            if ending is not None:
                self.saved = with_metadata(self.saved, ending)
        layout = layout_of(lines, self.source, CSV_MARK)
        self._separator, self._below = layout.separator, layout.below
        self.headers = layout.headers
        self.header_place = f"{self.source}, line {layout.header_line}"
        if layout.bare:
            self.header_place += " (numbers, no header)"
        self.notes: dict[str, Any] = {}
        whole = ending is None
        if (
            whole
            and self.saved is None
            and (cut := without_torn_line(self._content, layout)) is not None
        ):
            self._content, whole = cut, False
            self.notes["incomplete"] = TORN
        self._stream: Path | None = None
        few = len(self.headers) <= _FEW
        if self._separator != BLANK and (few or not long):
            self._table = _core.number_table(
                self._content, self._below, self._separator, len(self.headers)
            )
        if self._table is None and long and '"' not in self._content:
            if few:
                self._table = plain_numbers(
                    path if whole else each_line(self._content),
                    self._below,
                    self._separator,
                    len(self.headers),
                )
            if (
                self._table is None
                and whole
                and self._separator != BLANK
                and even_rows(self._content, self._below, self._separator, len(self.headers))
            ):
                self._stream = path
        if self._stream is not None:
            return
        if self._table is None:
            if not self._rows and ending is not None:
                raise InputError(no_sample(ending), place=self.source)
            if not self._rows:
                raise InputError("the file has a header, but no rows", place=self.header_place)
            self._refuse_ragged_rows()

    def numbers(self, columns: Sequence[int]) -> list[FloatArray]:
        """Return columns as arrays of shape (n,), or raise `InputError` for a cell that is not a number."""
        if self._table is not None:
            return [np.ascontiguousarray(self._table[:, column]) for column in columns]
        if self._stream is not None:
            table = plain_numbers(
                self._stream, self._below, self._separator, len(columns), list(columns)
            )
            if table is not None:
                return list(table.T.copy())
        rows, separator, used = self._rows, self._separator, list(columns)
        if separator != "," and any("," in row for row in rows):
            rows, separator, used = self._with_points(columns), _INNER, list(range(len(columns)))
        if not any(map(str.strip, rows)):
            raise self._invalid(columns, "all cells are empty")
        try:
            # NOTE: without `comments=None` a '#' would cut a line short.
            table = np.loadtxt(
                rows,
                delimiter=None if separator == BLANK else separator,
                usecols=used,
                dtype=np.float64,
                comments=None,
                quotechar='"',
                ndmin=2,
            )
        except ValueError as error:
            raise self._invalid(columns, str(error)) from None
        if len(table) != len(self._rows):
            raise self._invalid(columns, f"{len(self._rows)} lines hold {len(table)} rows")
        return list(table.T)

    def text(self, column: int) -> list[str]:
        """Return the cells of a column, without blanks around them."""
        return self._columns([column])[0]

    def list_widths(self) -> dict[int, int]:
        """Return column → count of numbers in its first cell, for columns of lists."""
        first = self._first_row if self._table is None and self._stream is None else ""
        if not any(bracket in first for bracket in "[("):
            return {}
        found = enumerate(map(list_of, self._cells(first, self._below + 1)))
        return {column: len(numbers) for column, numbers in found if numbers}

    def lists(self, column: int, width: int) -> FloatArray:
        """Return a column of lists, of shape (n, width), or raise `InputError`."""
        cells = self.text(column)
        numbers = [list_of(cell) for cell in cells]
        self._texts.count(self._content, len(cells) * (1 + width))
        for row, found in enumerate(numbers):
            if found is None or len(found) != width:
                raise InputError(
                    f"{cells[row][:40]!r} is not a list of {width} numbers; the first row has {width} numbers",
                    place=self.place(column, row),
                )
        return np.array(numbers, dtype=np.float64)

    def first_cell(self, column: int) -> str:
        """Return the first cell of a column."""
        cells = self._cells(self._first_row, self._below + 1)
        return cells[column] if column < len(cells) else ""

    def place(self, column: int, row: int) -> str:
        """Return the place of a cell: file, line and column."""
        # No list of lines: this may be the only line needed of a million.
        numbered = enumerate(each_line(self._content), 1)
        below = (k for k, line in numbered if k > self._below and _is_row(line))
        line = next(islice(below, row, None))
        return f"{self.source}, line {line}, column {self.headers[column]!r}"

    @cached_property
    def _first_row(self) -> str:
        """Return the first non-blank line below the header, within the searched lines."""
        for length in (_SHORT, _LONG):
            lines = _lines(self._content[:length])[self._below :]
            if length < min(_LONG, len(self._content)):
                lines = lines[:-1]  # the last one may be cut
            if first := next((line for line in lines if line.strip()), ""):
                return first
        return ""

    @cached_property
    def _line_numbers(self) -> list[int]:
        """1-based line number of each row; blank lines do not count."""
        self._texts.count(self._content)
        below = _lines(self._content)[self._below :]
        return [number for number, line in enumerate(below, self._below + 1) if _is_row(line)]

    @cached_property
    def _rows(self) -> list[str]:
        numbers = self._line_numbers  # this counts the memory of the lines
        lines = _lines(self._content)
        return [lines[number - 1] for number in numbers]

    def _with_points(self, columns: Sequence[int]) -> list[str]:
        """Return the rows with these columns only, with points instead of decimal commas."""
        cells = self._columns(columns)
        doubt = decimal_comma(cells)
        if doubt is not None:
            column, row, reason = doubt
            raise InputError(
                reason, place=self.place(columns[column], row), remedy="write decimal points"
            )
        return [_INNER.join(row).replace(",", ".") for row in zip(*cells, strict=True)]

    def _columns(self, columns: Sequence[int]) -> list[list[str]]:
        self._texts.count(self._content, len(self._rows) * len(columns))
        found: list[list[str]] = [[] for _ in columns]
        for row, number in zip(self._rows, self._line_numbers, strict=True):
            cells = self._cells(row, number)
            for column, kept in zip(columns, found, strict=True):
                kept.append(cells[column])
        return found

    def _refuse_ragged_rows(self) -> None:
        for row, number in zip(self._rows, self._line_numbers, strict=True):
            plain = '"' not in row
            plain = plain and self._separator != BLANK
            count = row.count(self._separator) + 1 if plain else len(self._cells(row, number))
            if count != len(self.headers):
                hint = ""
                if count > len(self.headers) and self._separator == ",":
                    hint = " (write decimal points, not commas)"
                raise InputError(
                    f"{count} cells, but {len(self.headers)} headers; every row needs one cell per "
                    f"header{hint}",
                    place=f"{self.source}, line {number}",
                )

    def _cells(self, line: str, number: int) -> list[str]:
        if len(line) > _LONG:
            self._texts.count(line, len(line) // 2)
        try:
            return cells_of(line, self._separator)
        except csv.Error as error:
            raise InputError(
                f"quotation marks do not match ({error})", place=f"{self.source}, line {number}"
            ) from None

    def _invalid(self, columns: Sequence[int], reason: str) -> InputError:
        for row, line in enumerate(self._rows):
            cells = self._cells(line, self._line_numbers[row])
            if tuple(cells) == tuple(self.headers):
                raise self._appended(self._line_numbers[row])
            for column in columns:
                if number_of(cells[column], self._separator) is None:
                    return InputError(_no_number(cells[column]), place=self.place(column, row))
        return InputError(
            f"the numbers cannot be read ({' '.join(reason.split())})", place=self.source
        )

    def _appended(self, line: int) -> InputError:
        file = shlex.quote(str(self.source))
        return RepeatedHeaderError(
            "the headers are repeated here, as if another file was appended",
            place=f"{self.source}, line {line}",
            remedy=f"cut the file there (head -n {line - 1} {file} > run_1.csv; tail -n +{line} {file} > run_2.csv), "
            "and give both files",
        )


def _lines(text: str) -> list[str]:
    return text.replace("\r\n", "\n").replace("\r", "\n").split("\n")


def _is_row(line: str) -> bool:
    """Whether a line below the header is neither blank nor a comment."""
    return bool(line.strip()) and not is_comment(line)


def _first_lines(text: str) -> list[str]:
    """Return the lines that determine where the table begins: all, or more than are searched."""
    for length in (_SHORT, _LONG):
        if len(text) > length:
            lines = _lines(text[:length])[:-1]
            if length == _LONG and not lines:
                raise InputError("the first line is longer than 1 MB; a header is expected")
            if length == _LONG or _more_than(SEARCHED, lines):
                return lines
    return _lines(text)


def _more_than(count: int, lines: Sequence[str]) -> bool:
    """Return whether more than `count` lines are neither empty nor comments."""
    if len(lines) > count and all(map(_BEGINS_AT_ONCE, lines[: count + 1])):
        return True
    return next(islice(filter(_is_row, lines), count, None), None) is not None


def _no_number(cell: str) -> str:
    what = f"{cell[:40]!r} is not a number" if cell else "the cell is empty"
    if re.fullmatch(r"[+-]?\d*,\d+", cell):
        return f"{what}; decimal commas are read only where semicolons or tabs separate the cells"
    if re.search(r"\d:\d\d", cell):
        if re.search(r"\d/\d", cell):
            return f"{what}; the order of day and month is not clear; write dates like 2025-11-01 12:26:40.5"
        return (
            f"{what}; clock times among numbers cannot be read; seconds such as 0.25 are expected"
        )
    return f"{what}; a number such as 0.25 is expected"


def _opened(path: Path) -> Table:
    """Return a text file from any program as a table."""
    text = text_of(path)
    top = _top(text, 100)
    separator = separator_of_scope(top)
    if separator is not None:
        return ScopeTable(str(path), text, separator)
    paired = paired_columns(top)
    return CsvTable(path, text) if paired is None else _table_of_pairs(path, text, paired)


def _table_of_pairs(path: Path, text: str, paired: Paired) -> ScopeTable:
    """Return a text of X,Y pairs, read like an export of TwinCAT Scope."""
    above = re.match(rf"(?:[^\r\n]*(?:\r\n|\r|\n)){{{paired.lines}}}", text)
    names = paired.separator.join(name or "Name" for name in paired.names)
    units = paired.separator.join(("Unit", *paired.units[1:]))
    rows = text[above.end() if above else 0 :]
    time = f"time [{paired.time_unit}]" if paired.time_unit else "time"
    table = ScopeTable(str(path), f"{names}\n{units}\n{rows}", paired.separator, time)
    if paired.recognised:
        table.notes["recognised_units"] = {"time": paired.time_unit}
    return table


def _top(text: str, count: int) -> list[str]:
    """Return the first lines of a text."""
    lines = text[:_SHORT].splitlines()
    return (lines if len(lines) > count else text[:_LONG].splitlines())[:count]


READER = Reader(endings=(".csv", ".csv.gz", ".txt", ".tsv", ".log", ".dat"), open=_opened)
