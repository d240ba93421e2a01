"""Reading .parquet files with pyarrow, which the extra `parquet` installs."""

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np
import numpy.typing as npt

from jointid.base.error_text import reason_of
from jointid.base.errors import InputError
from jointid.base.unpacking import Room
from jointid.recording.readers.parquet_sizes import Sizes
from jointid.recording.readers.reader import Reader
from jointid.recording.signals import FloatArray, signal_array

_CELL = 60  # bytes of a cell as text
_ROWS = 1024  # rows per batch
_BY_DIFFERENCES = {6, 7}  # DELTA_LENGTH_BYTE_ARRAY and DELTA_BYTE_ARRAY


class ParquetTable:
    """A .parquet file as a table of columns; only the columns used are read.

    Parameters
    ----------
    path : Path

    Raises
    ------
    InputError
        The file is not a .parquet file, or is damaged.
    ModuleNotFoundError
        pyarrow is not installed.
    """

    saved: Mapping[str, Any] | None = None
    other_names: Mapping[str, int] = MappingProxyType({})

    def __init__(self, path: Path) -> None:
        self.source = str(path)
        self.header_place = self.source
        self._room = Room(path)
        self._taken: set[int] = set()
        content = path.read_bytes()
        import pyarrow
        from pyarrow import parquet

        try:
            self._file: Any = parquet.ParquetFile(pyarrow.BufferReader(content))
            names = self._file.schema_arrow.names
            self._sizes = Sizes(content)
            texts = _texts(self._file, self._sizes)
            if texts:  # as a dictionary: a text that is repeated a million times is kept once
                self._file = parquet.ParquetFile(
                    pyarrow.BufferReader(content), read_dictionary=texts
                )
        except _damage() as error:
            raise InputError(
                f"the file is not a .parquet file, or is damaged ({reason_of(error)})",
                place=str(path),
            ) from None
        self.headers = tuple(map(str, names))
        schema = self._file.metadata.schema
        self._leaves = [(schema.column(leaf).path, leaf) for leaf in range(len(schema.names))]
        if not self.headers:
            raise InputError(
                "the file has no columns; time and position are expected", place=str(path)
            )

    @property
    def rows(self) -> int:
        """Number of rows."""
        return int(self._sizes.rows)

    def numbers(self, columns: Sequence[int]) -> list[FloatArray]:
        """Return columns as arrays of shape (n,), or raise `InputError`."""
        return [self._numbers(column) for column in columns]

    def raw(self, column: int) -> npt.NDArray[Any] | None:
        """Return integers and dates as the file has them; None for other columns."""
        import pyarrow

        values, types = self._values(column), pyarrow.types
        if types.is_dictionary(values.type):
            return None
        dates = types.is_timestamp(values.type) or types.is_duration(values.type)
        if not dates and (values.null_count or not types.is_integer(values.type)):
            return None
        try:
            return np.asarray(values.to_numpy())
        except _damage() as error:
            raise self._unreadable(column, error) from None

    def list_widths(self) -> dict[int, int]:
        """Return column → count of numbers in its first cell, for columns of lists."""
        from pyarrow import types

        found = {}
        for column, field in enumerate(self._file.schema_arrow):
            fixed = types.is_fixed_size_list(field.type)
            if not (fixed or types.is_list(field.type) or types.is_large_list(field.type)):
                continue
            if _is_number(field.type.value_type) and self._sizes.rows:
                first = None if fixed else next(self._list_batches(column, 1))[0].as_py()
                found[column] = field.type.list_size if fixed else len(first or ())
        return {column: width for column, width in found.items() if width}

    def lists(self, column: int, width: int) -> FloatArray:
        """Return a column of lists, of shape (n, width), or raise `InputError`."""
        import pyarrow

        parts, row = [], 0
        for rows in self._list_batches(column, _ROWS):
            whole = not rows.null_count
            if whole and not pyarrow.types.is_fixed_size_list(rows.type):
                whole = set(rows.value_lengths().to_pylist()) == {width}
            if not whole:
                raise InputError(
                    f"every row needs a list of {width} numbers, as the first row has",
                    place=f"{self._place(column)}, in rows {row} to {row + len(rows) - 1}",
                )
            place = self._place(column)
            parts.append(signal_array("", rows.flatten().to_numpy(zero_copy_only=False), place))
            row += len(rows)
        return np.concatenate(parts).reshape(-1, width)

    def _list_batches(self, column: int, size: int) -> Iterator[Any]:
        name = self._file.schema_arrow.field(column).name
        try:
            for batch in self._file.iter_batches(size, columns=[name], use_threads=False):
                self._room.take(2 * batch.nbytes)
                yield batch.column(0)
        except InputError:
            raise
        except _damage() as error:
            raise self._unreadable(column, error) from None

    def text(self, column: int) -> list[str]:
        """Return the values of a column as text."""
        import pyarrow

        values = self._values(column)
        if not pyarrow.types.is_dictionary(values.type):
            return list(map(str, values.to_pylist()))
        cells = []
        for chunk in values.chunks:  # a repeated text stays one object
            words = [*map(str, chunk.dictionary.to_pylist()), "None"]  # -1: an empty cell
            cells += [words[place] for place in chunk.indices.fill_null(-1).to_pylist()]
        return cells

    def place(self, column: int, row: int) -> str:
        """Return the place of a value: file, 0-based row and column."""
        return f"{self.source}, row {row}, column {self.headers[column]!r}"

    def _numbers(self, column: int) -> FloatArray:
        import pyarrow

        values = self._values(column)
        if pyarrow.types.is_temporal(values.type):
            raise InputError(
                f"the column holds {values.type}; numbers are expected (for time: seconds since "
                "the start)",
                place=self._place(column),
            )
        if values.null_count:
            row = int(np.argmax(values.is_null().to_numpy()))
            raise InputError(
                "the cell is empty; a number is expected", place=self.place(column, row)
            )
        try:
            if pyarrow.types.is_decimal(values.type):
                values = values.cast(pyarrow.float64())
            text = pyarrow.types.is_dictionary(values.type)
            array = np.array(self.text(column), object) if text else values.to_numpy()
        except _damage() as error:
            raise self._unreadable(column, error) from None
        return signal_array("", array, self._place(column))

    def _values(self, column: int) -> Any:
        import pyarrow

        field = self._file.schema_arrow.field(column)
        name, kind = field.name, _stored(field.type)
        if pyarrow.types.is_nested(kind):
            raise InputError(
                f"the column holds {field.type!s:.60}; numbers are expected",
                place=self._place(column),
            )
        try:
            if column not in self._taken:  # a column may be read more than once
                own = (leaf for path, leaf in self._leaves if f"{path}.".startswith(f"{name}."))
                cell = 8 if _is_number(kind) else _CELL
                self._room.take(max(cell * self._sizes.rows, sum(map(self._sizes.of, own))))
                self._taken.add(column)
            if not (_is_number(kind) or pyarrow.types.is_dictionary(kind)):
                return self._in_batches(name, field.type)
            # One thread: the columns are small, and thread pools cause trouble after a fork.
            values = self._file.read(columns=[name], use_threads=False).column(name)
            if not _is_number(kind):
                values.validate(full=True)  # refuses indices beyond the dictionary's end
        except InputError:
            raise
        except _damage() as error:
            raise self._unreadable(column, error) from None
        return values

    def _in_batches(self, name: str, kind: Any) -> Any:
        """Read texts in batches if no header states their total length (repeated prefixes, or all texts equal)."""
        import pyarrow

        chunks = []
        for batch in self._file.iter_batches(_ROWS, columns=[name], use_threads=False):
            self._room.take(batch.nbytes)
            chunks.append(batch.column(0))
        return pyarrow.chunked_array(chunks, kind)

    def _place(self, column: int) -> str:
        return f"{self.source}, column {self.headers[column]!r}"

    def _unreadable(self, column: int, error: BaseException) -> InputError:
        return InputError(
            f"the column cannot be read ({reason_of(error)})", place=self._place(column)
        )


def _is_number(kind: Any) -> bool:
    """Whether each cell of a column is a number, a date or empty, of a few bytes."""
    from pyarrow import types

    kind = _stored(kind)
    return bool(
        types.is_integer(kind)
        or types.is_floating(kind)
        or types.is_boolean(kind)
        or types.is_decimal(kind)
        or types.is_temporal(kind)
        or types.is_null(kind)
    )


def _stored(kind: Any) -> Any:
    """Return the storage type of an extension type."""
    return getattr(kind, "storage_type", kind)


def _texts(file: Any, sizes: Sizes) -> list[str]:
    """Return the columns of texts or other bytes that can be read as a dictionary."""
    schema = file.metadata.schema
    leaves = {schema.column(leaf).path: leaf for leaf in range(len(schema.names))}
    return [
        field.name
        for field in file.schema_arrow
        if field.name in leaves
        and not _is_number(field.type)
        and not sizes.encodings(leaves[field.name]) & _BY_DIFFERENCES
    ]


def _damage() -> tuple[type[Exception], ...]:
    """Return the errors of pyarrow for damaged bytes; pyarrow documents none of them."""
    import pyarrow

    return (
        *(pyarrow.ArrowException, ValueError, OSError, EOFError, LookupError),
        *(RuntimeError, NotImplementedError, MemoryError, OverflowError),
    )


READER = Reader(endings=(".parquet",), open=ParquetTable, package="pyarrow")
