"""Reading the folder of a LeRobot dataset, versions 2 and 3, with pyarrow, which the extra `parquet` installs."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np
import numpy.typing as npt

from jointid.base.errors import InputError
from jointid.recording.readers.lerobot import INFO
from jointid.recording.readers.parquet_reader import ParquetTable
from jointid.recording.readers.reader import Reader
from jointid.recording.signals import FloatArray
from jointid.recording.table import raw_values


class StackedTable:
    """The rows of several .parquet files with the same columns, one file after the other.

    Parameters
    ----------
    path : Path
        The dataset's folder.

    Raises
    ------
    InputError
        There is no file with rows, or two files differ in columns.
    """

    saved: Mapping[str, Any] | None = None
    other_names: Mapping[str, int] = MappingProxyType({})

    def __init__(self, path: Path) -> None:
        self.source = self.header_place = str(path)
        files = sorted((path / "data").rglob("*.parquet"))
        if not files:
            raise InputError("the dataset has no rows: no .parquet file in data", place=str(path))
        self._parts = [ParquetTable(file) for file in files]
        self.headers = self._parts[0].headers
        for part in self._parts:
            if part.headers != self.headers:
                raise InputError(
                    f"its columns differ from the columns of {files[0].name}", place=part.source
                )
        self._starts = np.cumsum([0, *(part.rows for part in self._parts)])

    def numbers(self, columns: Sequence[int]) -> list[FloatArray]:
        """Return columns as arrays of shape (n,), or raise `InputError`."""
        each = [part.numbers(columns) for part in self._parts]
        return [np.concatenate(column) for column in zip(*each, strict=True)]

    def raw(self, column: int) -> npt.NDArray[Any] | None:
        """Return integers and dates as the files have them; None for other columns."""
        values = [raw_values(part, column) for part in self._parts]
        known = [each for each in values if each is not None]
        return np.concatenate(known) if len(known) == len(values) else None

    def text(self, column: int) -> list[str]:
        """Return the values of a column as text."""
        return [cell for part in self._parts for cell in part.text(column)]

    def list_widths(self) -> dict[int, int]:
        """Return column → count of numbers in its first cell, for columns of lists."""
        return self._parts[0].list_widths()

    def lists(self, column: int, width: int) -> FloatArray:
        """Return a column of lists, of shape (n, width), or raise `InputError`."""
        return np.concatenate([part.lists(column, width) for part in self._parts])

    def place(self, column: int, row: int) -> str:
        """Return the place of a value: file, 0-based row and column."""
        part = int(np.searchsorted(self._starts, row, side="right")) - 1
        part = min(part, len(self._parts) - 1)
        return self._parts[part].place(column, row - int(self._starts[part]))


READER = Reader(endings=(), open=StackedTable, package="pyarrow", marker=INFO)
