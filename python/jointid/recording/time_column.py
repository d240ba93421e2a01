"""Reading the time column of a table without rounding, if its stamps require it."""

from typing import Any

import numpy as np
import numpy.typing as npt

from jointid.base.errors import InputError
from jointid.recording.columns import Column
from jointid.recording.stamps import (
    Stamps,
    fraction_of,
    looks_exact,
    stamps_of,
    stamps_of_clock,
    stamps_of_integers,
    with_fraction,
)
from jointid.recording.table import Table, first_cell, raw_values


def exact_time(table: Table, column: Column) -> Stamps | None:
    """Return the stamps of a time column if floats would round them; otherwise None.

    Parameters
    ----------
    table : Table
    column : Column
        The time column.

    Raises
    ------
    InputError
        The unit of the stamps is in doubt, or a stamp is missing.
    """
    beside = fraction_of(table.headers, column.index)
    if beside is not None:
        whole, fraction = table.numbers([column.index, beside[0]])
        seconds = with_fraction(whole, fraction, beside[1])
        if seconds is not None:
            return Stamps(seconds=seconds, first=f"{whole[0]:.0f} s {fraction[0]:.0f}")
    place = f"{table.header_place}, column {table.headers[column.index]!r}"
    if looks_exact(first_cell(table, column.index)):
        return stamps_of(table.text(column.index), column.unit, place)
    raw = raw_values(table, column.index)
    return None if raw is None else _of_raw(table, column, raw, place)


def _of_raw(table: Table, column: Column, raw: npt.NDArray[Any], place: str) -> Stamps | None:
    if raw.ndim != 1 or not len(raw):
        return None
    if raw.dtype.kind in "mM":
        if np.datetime_data(raw.dtype)[0] == "generic":
            raise InputError(
                "its numbers are dates or durations without a unit; seconds are expected",
                place=table.place(column.index, 0),
            )
        if (missing := np.isnat(raw)).any():
            raise InputError(
                "the cell is empty; a time is expected",
                place=table.place(column.index, int(np.argmax(missing))),
            )
        return stamps_of_clock(raw)
    whole = raw.dtype.kind in "iu" or (
        raw.dtype.kind == "O" and all(type(each) is int for each in raw)
    )
    return stamps_of_integers(raw, column.unit, place) if whole else None


def stamps_note(stamps: Stamps) -> dict[str, Any]:
    """Return the metadata entries on a recording's stamps."""
    note: dict[str, Any] = {"first_stamp": stamps.first}
    if stamps.recognised:
        note["recognised_units"] = {"time": stamps.recognised}
    return note
