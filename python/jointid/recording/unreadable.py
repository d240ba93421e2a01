"""Cells that are no numbers, among numbers: a table that reads them as missing, for rows that may be left out."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from jointid.base.argument_checks import number_in
from jointid.base.errors import InputError
from jointid.base.unpacking import TooLargeError
from jointid.recording.contents import Contents
from jointid.recording.damaged_rows import DROP, RepeatedHeaderError, few
from jointid.recording.signals import FloatArray
from jointid.recording.table import RenamedTable, Table


def read_leniently(
    read: Callable[[Table], Contents], table: Table, *, drop_invalid: bool
) -> Contents:
    """Return the contents of a table; cells that are no numbers are NaN if damaged rows may be left out.

    Raises
    ------
    InputError
        As `read`; where leaving out rows would help and is not asked for, it says so.
    """
    if drop_invalid:
        return read(TolerantTable(table))
    try:
        return read(table)
    except (TooLargeError, RepeatedHeaderError):  # as text its cells would hold still more
        raise
    except InputError as error:
        refused = error
    try:
        read(TolerantTable(table))
    except InputError:
        raise refused from None
    raise InputError(
        refused.reason,
        argument=refused.argument,
        value=refused.value,
        place=refused.place,
        remedy=(*refused.remedy, DROP),
    )


class TolerantTable(RenamedTable):
    """A table whose empty and unreadable cells are NaN, in columns where they are few.

    Parameters
    ----------
    table : Table
    """

    def __getattr__(self, name: str) -> Any:
        """What only some tables have, such as the cells' own numbers."""
        return getattr(self._table, name)

    def numbers(self, columns: Sequence[int]) -> list[FloatArray]:
        """Return columns as numbers; raise `InputError` for one with many cells that are none."""
        try:
            return self._table.numbers(columns)
        except TooLargeError:
            raise
        except InputError:
            return [self._column(column) for column in columns]

    def _column(self, column: int) -> FloatArray:
        try:
            (values,) = self._table.numbers([column])
        except TooLargeError:
            raise
        except InputError:
            cells = (number_in(cell) for cell in self._table.text(column))
            values = np.array([np.nan if each is None else float(each) for each in cells])
            if not few(np.isfinite(values)):  # a column of another kind, not damaged rows
                raise
        return values
