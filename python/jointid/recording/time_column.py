"""The time column of a table read without rounding, where its stamps ask for it."""

from typing import Any

from jointid.recording.columns import Column
from jointid.recording.stamps import Stamps, fraction_of, looks_exact, stamps_of, with_fraction
from jointid.recording.table import Table, first_cell


def exact_time(table: Table, column: Column) -> Stamps | None:
    """Return the stamps of a time column that numbers would round; None if they would not.

    Parameters
    ----------
    table : Table
    column : Column
        That holds the time.
    """
    beside = fraction_of(table.headers, column.index)
    if beside is not None:
        whole, fraction = table.numbers([column.index, beside[0]])
        seconds = with_fraction(whole, fraction, beside[1])
        if seconds is not None:
            return Stamps(seconds=seconds, first=f"{whole[0]:.0f} s {fraction[0]:.0f}")
    if looks_exact(first_cell(table, column.index)):
        return stamps_of(table.text(column.index), column.unit)
    return None


def stamps_note(stamps: Stamps) -> dict[str, Any]:
    """Return what a recording's metadata say about its stamps."""
    note: dict[str, Any] = {"first_stamp": stamps.first}
    if stamps.recognised:
        note["recognised_units"] = {"time": stamps.recognised}
    return note
