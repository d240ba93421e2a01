"""Reading .parquet files, with pyarrow, which an extra brings."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np

from jointid.base.error_text import reason_of
from jointid.base.errors import InputError
from jointid.recording.readers.reader import Reader
from jointid.recording.signals import FloatArray, signal_array


class ParquetTable:
    """A .parquet file as a table of columns; only those asked for are read.

    Parameters
    ----------
    path : Path

    Raises
    ------
    InputError
        The file is no .parquet file.
    ModuleNotFoundError
        pyarrow is not installed.
    """

    saved: Mapping[str, Any] | None = None
    other_names: Mapping[str, int] = MappingProxyType({})

    def __init__(self, path: Path) -> None:
        self.source = str(path)
        self.header_place = self.source
        content = path.read_bytes()
        import pyarrow
        from pyarrow import parquet

        try:
            self._file: Any = parquet.ParquetFile(pyarrow.BufferReader(content))
            self.headers = tuple(map(str, self._file.schema_arrow.names))
        # NOTE: whatever the damage leads to: the reader promises no kind of error.
        except Exception as error:
            raise InputError(
                f"{path}: the file is no .parquet file, or is damaged ({reason_of(error)})"
            ) from None
        if not self.headers:
            raise InputError(f"{path}: the file has no columns; time and position are expected")

    def numbers(self, columns: Sequence[int]) -> list[FloatArray]:
        """Return columns as arrays of shape (n,), or name the one that is none."""
        return [self._numbers(column) for column in columns]

    def text(self, column: int) -> list[str]:
        """Return the values of a column as text."""
        return [str(value) for value in self._values(column).to_pylist()]

    def place(self, column: int, row: int) -> str:
        """Return file, 0-based row and column of a value."""
        return f"{self.source}, row {row}, column {self.headers[column]!r}"

    def _numbers(self, column: int) -> FloatArray:
        import pyarrow

        what = f"column {self.headers[column]!r}"
        values = self._values(column)
        if pyarrow.types.is_temporal(values.type):
            raise InputError(
                f"{self.source}: {what} holds {values.type}; numbers are expected, for time "
                "seconds since the start"
            )
        if values.null_count:
            row = int(np.argmax(values.is_null().to_numpy()))
            raise InputError(f"{self.place(column, row)}: the cell is empty; a number is expected")
        try:
            if pyarrow.types.is_decimal(values.type):
                values = values.cast(pyarrow.float64())
            array = values.to_numpy()
        except Exception as error:
            raise self._unreadable(column, error) from None
        return signal_array(what, array, self.source)

    def _values(self, column: int) -> Any:
        name = self._file.schema_arrow.names[column]
        try:
            # One thread: what is read here is small, and pools of threads outlive a fork badly.
            return self._file.read(columns=[name], use_threads=False).column(name)
        except Exception as error:
            raise self._unreadable(column, error) from None

    def _unreadable(self, column: int, error: BaseException) -> InputError:
        return InputError(
            f"{self.source}: column {self.headers[column]!r} cannot be read ({reason_of(error)})"
        )


READER = Reader(endings=(".parquet",), open=ParquetTable, package="pyarrow", extra="parquet")
