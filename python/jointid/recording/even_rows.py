"""A table with a time column from a stated sample period."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from jointid.base.advice import Action
from jointid.base.argument_checks import is_finite
from jointid.base.errors import InputError
from jointid.recording.headers import understood
from jointid.recording.signals import FloatArray
from jointid.recording.table import Table

EVENLY = Action(
    "call", {"sample_period": ...}, "if the rows have a constant sample period", function="load"
)
_HEADER = "time [s]"


def as_stated(
    table: Table, sample_period: object, columns: Mapping[str, str | int | None] | None
) -> tuple[Table, Mapping[str, str | int | None] | None]:
    """Apply the call's blocks of joints and sample period to a table; return it and the columns of its signals.

    Parameters
    ----------
    table : Table
    sample_period : float or None
        Time between rows [s]. None: the table has a time column.
    columns : mapping or None
        Same as in `load`.

    Raises
    ------
    InputError
        The period is not a positive number, a time column is also named, or a block cannot be read.
    """
    if isinstance(columns, Mapping) and any(":" in str(each) for each in columns.values()):
        from jointid.recording.blocks import with_blocks

        table, columns = with_blocks(table, columns)
    if sample_period is None:
        return table, columns
    if not is_finite(sample_period) or float(sample_period) <= 0.0:  # type: ignore[arg-type]
        raise InputError(
            "a positive number of seconds is expected",
            argument="sample_period",
            value=sample_period,
        )
    given = columns if isinstance(columns, Mapping) else {}
    if table.saved is not None or given.get("time") is not None:
        raise InputError(
            "the file has a time column, so no sample period is expected",
            argument="sample_period",
            value=sample_period,
            place=table.source,
            remedy="leave sample_period out",
        )
    return EvenRows(table, float(sample_period)), {**given, "time": len(table.headers)}  # type: ignore[arg-type]


class EvenRows:
    """A table with an added time column, for rows taken at an even rate.

    Parameters
    ----------
    table : Table
    sample_period : float
        Time between rows [s].
    """

    def __init__(self, table: Table, sample_period: float) -> None:
        self._table, self._period = table, sample_period
        self.source = table.source
        self.headers = (*table.headers, _HEADER)
        self.other_names: Mapping[str, int] = table.other_names
        self.header_place = table.header_place
        self.saved: Mapping[str, Any] | None = None
        stamps = [
            header
            for header in table.headers
            if (meaning := understood(header).meaning) is not None and meaning.signal == "time"
        ]
        self._unread = [
            {
                "column": header,
                "signal": "time",
                "reason": f"the call states a sample period of {sample_period:g} s",
            }
            for header in stamps
        ]

    @property
    def notes(self) -> dict[str, Any]:
        """Metadata entries on how the file was read."""
        notes = {**getattr(self._table, "notes", {}), "sample_period": self._period}
        return {**notes, "left_out": self._unread} if self._unread else notes

    def numbers(self, columns: Sequence[int]) -> list[FloatArray]:
        """Return columns as numbers."""
        own = len(self._table.headers)
        found = iter(self._table.numbers([column for column in columns if column != own]))
        values = [None if column == own else next(found) for column in columns]
        length = next((len(each) for each in values if each is not None), None)
        rows = np.arange(self._length() if length is None else length, dtype=np.float64)
        time: FloatArray = np.asarray(self._period * rows, dtype=np.float64)
        return [time if each is None else each for each in values]

    def _length(self) -> int:
        for column in range(len(self._table.headers)):
            try:
                return len(self._table.numbers([column])[0])
            except InputError:
                continue
        return len(self._table.text(0))

    def text(self, column: int) -> list[str]:
        """Return a column as text."""
        if column < len(self._table.headers):
            return self._table.text(column)
        return [repr(each) for each in self.numbers([column])[0].tolist()]

    def first_cell(self, column: int) -> str:
        """Return the first cell of a column as it is in the file."""
        from jointid.recording.table import first_cell

        return first_cell(self._table, column) if column < len(self._table.headers) else ""

    def raw(self, column: int) -> Any:
        """Return a column as the file has it."""
        from jointid.recording.table import raw_values

        return raw_values(self._table, column) if column < len(self._table.headers) else None

    def place(self, column: int, row: int) -> str:
        """Return the place of a cell."""
        return self._table.place(min(column, len(self._table.headers) - 1), row)
