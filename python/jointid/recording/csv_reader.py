"""Reading .csv and .csv.gz files: numbers by numpy's C parser, the culprit's line when it fails."""

import csv
import gzip
import zlib
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from jointid.errors import InputError
from jointid.recording.saving import CSV_MARK, saved_attributes
from jointid.recording.signals import FloatArray

_GZIP = b"\x1f\x8b"


class CsvTable:
    """A .csv or .csv.gz file as a table of columns: UTF-8, commas, decimal points, one header.

    Lines above the header may begin with ``#``; above bare numbers the last of them may be the
    header. Without any the headers are ``"column 0"``, ``"column 1"``, ...

    Parameters
    ----------
    path : Path

    Raises
    ------
    InputError
        The file cannot be read, is no such text, has no rows or rows of different lengths.
    """

    def __init__(self, path: Path) -> None:
        self.source = str(path)
        lines = _text(path).replace("\r\n", "\n").replace("\r", "\n").split("\n")
        self.saved: Mapping[str, Any] | None = None
        if lines[0].startswith(CSV_MARK):
            self.saved = saved_attributes(lines[0][len(CSV_MARK) :], f"{self.source}, line 1")
        first = next((k for k, line in enumerate(lines) if line.strip() and line[0] != "#"), None)
        if first is None:
            raise InputError(f"{self.source}: the file has no header and no rows")
        self._refuse_other_separators(lines[first], first + 1)
        below = self._read_header(lines, first)
        self._line_numbers = [
            number for number, line in enumerate(lines[below:], start=below + 1) if line.strip()
        ]
        self._rows = [lines[number - 1] for number in self._line_numbers]
        if not self._rows:
            raise InputError(f"{self.header_place}: a header, but no rows below it")
        self._refuse_ragged_rows()

    def numbers(self, columns: Sequence[int]) -> list[FloatArray]:
        """Return columns as arrays of shape (n,), or name the cell that is no number."""
        try:
            # NOTE: without `comments=None` a '#' would cut a line short.
            table = np.loadtxt(
                self._rows,
                delimiter=",",
                usecols=list(columns),
                dtype=np.float64,
                comments=None,
                quotechar='"',
                ndmin=2,
            )
        except ValueError as error:
            raise self._culprit(columns, str(error)) from None
        if len(table) != len(self._rows):
            raise self._culprit(columns, f"{len(self._rows)} lines hold {len(table)} rows")
        return list(table.T)

    def text(self, column: int) -> list[str]:
        """Return the cells of a column, without blanks around them."""
        return [
            self._cells(row, number)[column]
            for row, number in zip(self._rows, self._line_numbers, strict=True)
        ]

    def place(self, column: int, row: int) -> str:
        """Return file, line and column of a cell."""
        line = self._line_numbers[row]
        return f"{self.source}, line {line}, column {self.headers[column]!r}"

    def _read_header(self, lines: list[str], first: int) -> int:
        """Find the headers; return the index of the first line below them."""
        cells = self._cells(lines[first], first + 1)
        self.headers = tuple(cells)
        self.header_place = f"{self.source}, line {first + 1}"
        if any(_number(cell) is None for cell in cells):
            return first + 1
        above = next((k for k in reversed(range(first)) if lines[k].strip()), None)
        if above is not None and not lines[above].startswith(CSV_MARK):
            comment = self._cells(lines[above].lstrip("#"), above + 1)
            if len(comment) == len(cells):
                self.headers = tuple(comment)
                self.header_place = f"{self.source}, line {above + 1}"
                return first
        self.headers = tuple(f"column {k}" for k in range(len(cells)))
        self.header_place += " (numbers, no header)"
        return first

    def _refuse_other_separators(self, line: str, number: int) -> None:
        for sign, name in ((";", "semicolons"), ("\t", "tabs")):
            if sign in line and (sign == ";" or "," not in line):
                raise InputError(
                    f"{self.source}, line {number}: cells are separated by {name}; commas between "
                    "the cells and points in the numbers are expected, as in 0.5,1.25"
                )

    def _refuse_ragged_rows(self) -> None:
        for row, number in zip(self._rows, self._line_numbers, strict=True):
            count = len(self._cells(row, number)) if '"' in row else row.count(",") + 1
            if count != len(self.headers):
                hint = ""
                if count > len(self.headers):
                    hint = " (numbers take a decimal point, no comma)"
                elif number == self._line_numbers[-1]:
                    hint = " (the last line, perhaps cut off)"
                raise InputError(
                    f"{self.source}, line {number}: {count} cells where the header names "
                    f"{len(self.headers)}; every row needs one for each header{hint}"
                )

    def _cells(self, line: str, number: int) -> list[str]:
        if '"' not in line:
            return [cell.strip() for cell in line.split(",")]
        try:
            return [cell.strip() for cell in next(csv.reader([line], strict=True))]
        except csv.Error as error:
            raise InputError(
                f"{self.source}, line {number}: quotation marks do not match ({error})"
            ) from None

    def _culprit(self, columns: Sequence[int], reason: str) -> InputError:
        for row, line in enumerate(self._rows):
            cells = self._cells(line, self._line_numbers[row])
            for column in columns:
                if _number(cells[column]) is None:
                    cell = cells[column][:40]
                    what = f"{cell!r} is not a number" if cell else "the cell is empty"
                    return InputError(
                        f"{self.place(column, row)}: {what}; a number such as 0.25 is expected"
                    )
        return InputError(f"{self.source}: the numbers cannot be read ({' '.join(reason.split())})")


def _text(path: Path) -> str:
    content = path.read_bytes()
    if path.name.lower().endswith(".gz"):
        content = _unzipped(path, content)
    elif content.startswith(_GZIP):
        raise InputError(f"{path}: the file is compressed by gzip; its name must end in .csv.gz")
    try:
        text = content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = content.count(b"\n", 0, error.start) + 1
        raise InputError(
            f"{path}, line {line}: the byte 0x{content[error.start]:02x} is no UTF-8 text; "
            "save the file as UTF-8"
        ) from None
    if "\0" in text:
        line = text.count("\n", 0, text.index("\0")) + 1
        raise InputError(f"{path}, line {line}: a zero byte is no text; save the file as UTF-8")
    if not text.strip():
        raise InputError(f"{path}: the file is empty; a header and rows of numbers are expected")
    return text


def _unzipped(path: Path, content: bytes) -> bytes:
    if not content.startswith(_GZIP):
        raise InputError(
            f"{path}: the file is not compressed by gzip, as .gz says; name it .csv if it is text"
        )
    try:
        return gzip.decompress(content)
    except EOFError:
        raise InputError(
            f"{path}: the compressed file ends in the middle; copy or record it again"
        ) from None
    except (OSError, zlib.error) as error:
        raise InputError(f"{path}: the compressed file is damaged ({error})") from None


def _number(cell: str) -> float | None:
    """Return a cell's number as numpy's parser would, or None."""
    try:
        return float(cell) if cell.isascii() and "_" not in cell else None
    except ValueError:
        return None
