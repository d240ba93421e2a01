"""Blocks of columns, one column per joint, without joint names: ``columns={"position": "1:6"}``."""

import re
from collections.abc import Mapping

from jointid.base.advice import Action
from jointid.base.errors import InputError
from jointid.recording.signals import check_signal_name
from jointid.recording.table import RenamedTable, Table

_BLOCK = r"\s*(\d+)\s*:\s*(\d+)\s*"
_JOINT = "{joint}"
_UNIT = r"\s*[\[(][^\[\](),]*[\])]\s*$"
OF_BLOCKS = Action(
    "call",
    {"columns": {"time": "COLUMN", "position": "FIRST:LAST"}},
    "for several joints: first and last column number of each signal, e.g. position=1:6, torque=7:12; numbers start "
    "at 0",
    function="load_robot",
)
"""The call that loads a file with one block of columns per signal."""
Columns = Mapping[str, str | int | None]


def with_blocks(table: Table, columns: Columns) -> tuple[Table, Columns]:
    """Return a table with block columns named ``1.position``, ``2.position``, ..., and the columns outside blocks.

    Parameters
    ----------
    table : Table
    columns : mapping
        Same as in `load`. A block is written as its first and last column, 0-based, both included.

    Raises
    ------
    InputError
        A block is not in the table, two blocks share a column, their numbers of columns differ, or a single column
        is given for a signal of several joints.
    """
    known = {header.strip() for header in table.headers}
    blocks = {
        signal: (int(found[1]), int(found[2]))
        for signal, column in columns.items()
        if isinstance(column, str)
        and column.strip() not in known
        and (found := re.fullmatch(_BLOCK, column))
    }
    if not blocks:
        return table, columns
    joints: dict[int, tuple[str, int]] = {}
    widths = {signal: last - first + 1 for signal, (first, last) in blocks.items()}
    for signal, (first, last) in blocks.items():
        check_signal_name(signal, "columns")
        argument, value = f"columns.{signal}", f"{first}:{last}"
        if not first <= last < len(table.headers):
            raise InputError(
                f"the columns have the numbers 0 to {len(table.headers) - 1}; a block is stated by its first and "
                "last column",
                argument=argument,
                value=value,
                place=table.header_place,
            )
        if widths[signal] != next(iter(widths.values())):
            shown = ", ".join(f"{name}: {count}" for name, count in widths.items())
            raise InputError(
                f"all blocks need one column per joint, but their numbers of columns differ ({shown})",
                argument=argument,
                value=value,
                place=table.header_place,
            )
        for joint, index in enumerate(range(first, last + 1), 1):
            if index in joints:
                raise InputError(
                    f"column {index} is also in the block {joints[index][0]}",
                    argument=argument,
                    value=value,
                    place=table.header_place,
                )
            joints[index] = (signal, joint)
    rest = {signal: column for signal, column in columns.items() if signal not in blocks}
    shown, (first, last) = next(iter(blocks.items()))
    for signal, column in rest.items():
        check_signal_name(signal, "columns")
        if signal != "time" and last > first and column is not None and _JOINT not in str(column):
            raise InputError(
                f"a block of {last - first + 1} columns is expected, because {shown} has the block {first}:{last}",
                argument=f"columns.{signal}",
                value=column,
                place=table.header_place,
            )
    headers = [_header(header, joints.get(index)) for index, header in enumerate(table.headers)]
    own = {header: index for index, header in enumerate(table.headers) if index not in joints}
    return RenamedTable(table, headers, {**own, **table.other_names}), rest


def _header(header: str, joint: tuple[str, int] | None) -> str:
    """Return ``2.position [deg]`` for a column of a block, and any other header unchanged."""
    if joint is None:
        return header
    unit = re.search(_UNIT, header)
    return f"{joint[1]}.{joint[0]}{f' {unit[0].strip()}' if unit else ''}"
