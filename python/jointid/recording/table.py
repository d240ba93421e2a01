"""A table of named columns: the form in which every file and data frame is read."""

from collections.abc import Mapping, Sequence
from typing import Any, Protocol

import numpy as np
import numpy.typing as npt

from jointid.recording.signals import FloatArray

MOST_COLUMNS = 10_000


class Table(Protocol):
    """Named columns of a file or data frame."""

    @property
    def source(self) -> str:
        """Name of the table in messages, e.g. the file's path."""

    @property
    def headers(self) -> tuple[str, ...]:
        """Headers of the columns, one per column."""

    @property
    def other_names(self) -> Mapping[str, int]:
        """Names that `columns=` may use in addition to the headers → their columns."""

    @property
    def header_place(self) -> str:
        """Place of the headers, for messages."""

    @property
    def saved(self) -> Mapping[str, Any] | None:
        """Attributes of a saved recording; None if `Recording.save` did not write the table."""

    def numbers(self, columns: Sequence[int]) -> list[FloatArray]:
        """Return columns as numbers, each of shape (n,); raise `InputError` for a cell that is not a number."""

    def text(self, column: int) -> list[str]:
        """Return a column as text."""

    def place(self, column: int, row: int) -> str:
        """Return the place of a cell, for messages."""


def first_cell(table: Table, column: int) -> str:
    """Return the first cell of a column as it is in the file; empty if cells are not text."""
    found: str = table.first_cell(column) if hasattr(table, "first_cell") else ""
    return found


def raw_values(table: Table, column: int) -> npt.NDArray[Any] | None:
    """Return a column as the file has it, with integers and dates not rounded; None if cells are text."""
    if not hasattr(table, "raw"):
        return None
    values = table.raw(column)
    return None if values is None else np.asarray(values)


class RenamedTable:
    """Columns of another table under other headers; subclasses override what they change.

    Parameters
    ----------
    table : Table
    headers : sequence of str, optional
        New headers. Default: those of the table.
            other_names : mapping of str to int, optional
                New alternative names. Default: those of the table.
    indices : sequence of int, optional
        Number of each column in the other table. Default: all columns in order.
    """

    def __init__(
        self,
        table: Table,
        headers: Sequence[str] | None = None,
        other_names: Mapping[str, int] | None = None,
        indices: Sequence[int] | None = None,
    ) -> None:
        self._table = table
        self._indices = range(len(table.headers)) if indices is None else indices
        self.source, self.header_place, self.saved = table.source, table.header_place, table.saved
        self.headers = table.headers if headers is None else tuple(headers)
        self.other_names = table.other_names if other_names is None else other_names
        self._own_notes: dict[str, Any] = {}

    @property
    def notes(self) -> dict[str, Any]:
        """Metadata entries on how the file was read."""
        return {**getattr(self._table, "notes", {}), **self._own_notes}

    def numbers(self, columns: Sequence[int]) -> list[FloatArray]:
        """Return columns as numbers."""
        return self._table.numbers([self._indices[column] for column in columns])

    def text(self, column: int) -> list[str]:
        """Return a column as text."""
        return self._table.text(self._indices[column])

    def first_cell(self, column: int) -> str:
        """Return the first cell of a column as it is in the file."""
        return first_cell(self._table, self._indices[column])

    def raw(self, column: int) -> npt.NDArray[Any] | None:
        """Return a column as the file has it."""
        return raw_values(self._table, self._indices[column])

    def place(self, column: int, row: int) -> str:
        """Return the place of a cell."""
        return self._table.place(self._indices[column], row)
