"""Unreadable cells in columns of numbers: they are read as missing, so that their rows can be left out."""

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
    """Return the contents of a table; unreadable cells become NaN if damaged rows may be left out.

    Raises
    ------
    InputError
        Same errors as `read`. If leaving out rows would help, the message proposes it.
    """
    if drop_invalid:
        return read(TolerantTable(table))
    try:
        return read(table)
    except (TooLargeError, RepeatedHeaderError):  # as text, the cells would need even more memory
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
    """A table with NaN for empty and unreadable cells, in columns with few of them.

    Parameters
    ----------
    table : Table
    """

    def __getattr__(self, name: str) -> Any:
        """Return attributes that only some tables have, such as their own numbers of cells."""
        return getattr(self._table, name)

    def numbers(self, columns: Sequence[int]) -> list[FloatArray]:
        """Return columns as numbers; raise `InputError` for a column with many unreadable cells."""
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
            if not few(np.isfinite(values)):  # another kind of column, not damaged rows
                raise
        return values
