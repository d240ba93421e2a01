"""Columns of lists of numbers, split into one column per element: ``torques_0``, ``torques_1``, ..."""

import re
from collections.abc import Mapping, Sequence
from functools import cached_property
from typing import Any, Protocol

import numpy.typing as npt

from jointid.recording.signals import FloatArray
from jointid.recording.table import MOST_COLUMNS, Table, first_cell, raw_values

_LIST = re.compile(r"(?:array\('[df]', *|array\()?([\[(])(.*)[\])]\)?", re.DOTALL)
_SCALAR = re.compile(r"np\.float\d+\(([^()]*)\)")  # NumPy 2's form of a number in a list
_UNIT = re.compile(r"\s*[\[(][^\[\]()]*[\])]\s*$")


class HasLists(Table, Protocol):
    """A table that may have columns of lists."""

    def list_widths(self) -> Mapping[int, int]:
        """Return column → count of numbers in its first cell, for columns of lists."""

    def lists(self, column: int, width: int) -> FloatArray:
        """Return a column of lists, of shape (n, width); raise `InputError` for a cell that is not such a list."""


def list_of(cell: str) -> list[float] | None:
    """Return the numbers of a cell such as ``[0.1, 0.2]``, ``(0.1 0.2)`` or ``array('d', [0.1])``; None for others."""
    found = _LIST.fullmatch(_SCALAR.sub(r"\1", cell))
    if found is None:
        return None
    try:
        return [float(word) for word in re.split(r"[\s,;]+", found[2].strip("[]() ")) if word]
    except ValueError:
        return None


def with_list_columns(table: Table) -> Table:
    """Return a table with one number per row in every column."""
    widths = table.list_widths() if hasattr(table, "list_widths") else {}
    if not 0 < sum(widths.values()) <= MOST_COLUMNS:
        return table
    return ListColumns(table, widths)  # type: ignore[arg-type]


class ListColumns:
    """A table with one column per list element; a list of one element keeps its header.

    Parameters
    ----------
    table : HasLists
    widths : mapping of int to int
        Result of `HasLists.list_widths`.
    """

    def __init__(self, table: HasLists, widths: Mapping[int, int]) -> None:
        self._table = table
        self.source, self.header_place, self.saved = table.source, table.header_place, table.saved
        self._of = [
            (column, element)
            for column in range(len(table.headers))
            for element in range(widths.get(column, 1))
        ]
        self._widths = widths
        self.headers = tuple(
            table.headers[column]
            if widths.get(column, 1) == 1
            else _with_index(table.headers[column], element)
            for column, element in self._of
        )
        self._read: dict[int, FloatArray] = {}

    @property
    def notes(self) -> dict[str, Any]:
        """Metadata entries on how the file was read."""
        found: dict[str, Any] = getattr(self._table, "notes", {})
        return found

    @cached_property
    def other_names(self) -> Mapping[str, int]:
        """Names that `columns=` may use in addition to the headers."""
        whole = {column: k for k, (column, _) in enumerate(self._of) if column not in self._widths}
        return {n: whole[k] for n, k in self._table.other_names.items() if k in whole}

    def numbers(self, columns: Sequence[int]) -> list[FloatArray]:
        """Return columns as arrays of shape (n,), or raise `InputError`."""
        plain = [self._of[k][0] for k in columns if self._of[k][0] not in self._widths]
        values = iter(self._table.numbers(plain) if plain else ())
        found = []
        for k in columns:
            column, element = self._of[k]
            listed = column in self._widths
            found.append(self._lists(column)[:, element].copy() if listed else next(values))
        return found

    def raw(self, column: int) -> npt.NDArray[Any] | None:
        """Return the values of a column as the file has them; None for an element of a list."""
        own, _ = self._of[column]
        return None if own in self._widths else raw_values(self._table, own)

    def text(self, column: int) -> list[str]:
        """Return the values of a column as text."""
        own, element = self._of[column]
        if own not in self._widths:
            return self._table.text(own)
        return list(map(repr, self._lists(own)[:, element].tolist()))

    def first_cell(self, column: int) -> str:
        """Return the first cell of a column; empty for an element of a list."""
        own, _ = self._of[column]
        return "" if own in self._widths else first_cell(self._table, own)

    def place(self, column: int, row: int) -> str:
        """Return the place of a cell."""
        return self._table.place(self._of[column][0], row)

    def _lists(self, column: int) -> FloatArray:
        if column not in self._read:
            self._read[column] = self._table.lists(column, self._widths[column])
        return self._read[column]


def _with_index(header: str, element: int) -> str:
    """Return ``q_2 [rad]`` for ``q [rad]``."""
    unit = _UNIT.search(header)
    name = header[: unit.start()] if unit else header
    return f"{name}_{element}{unit[0] if unit else ''}"
