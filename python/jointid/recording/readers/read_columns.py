"""The columns of a table that a call of `load` reads."""

from collections.abc import Mapping
from typing import Any

from jointid.recording.even_rows import as_stated
from jointid.recording.extra import extra_columns
from jointid.recording.matching import match_columns
from jointid.recording.table import Table
from jointid.recording.wide.joint_in_table import joint_of_table
from jointid.recording.wide.joint_table import JointTable


def columns_read(table: Table, joint: str | None, reading: Mapping[str, Any]) -> set[int]:
    """Return the 0-based numbers of the columns that are read as signals.

    Parameters
    ----------
    table : Table
    joint : str or None
        Same as in `load`.
    reading : mapping
        Further arguments of the call of `load` that read the table.
    """
    extra = reading["extra"]
    timed, columns = as_stated(table, reading["sample_period"], reading["columns"])
    one = joint_of_table(timed, joint, columns, extra)
    units, scale = reading["units"] or {}, reading["scale"] or {}
    own = extra_columns(one.table, one.extra, units, scale)
    found = match_columns(
        one.table,
        columns=one.columns,
        units={name: unit for name, unit in units.items() if name not in own},
        scale={name: factor for name, factor in scale.items() if name not in own},
        kind=None,
    ).found
    read = {column.index for column in found.values()}
    read |= {column.index for column in own.values()}
    if isinstance(one.table, JointTable):
        read = {one.table.in_whole(index) for index in read}
    return read
