"""One joint of a table with several joints, as a table with its columns and the shared ones."""

import re
from collections.abc import Mapping, Sequence
from types import MappingProxyType

from jointid.base.advice import Action
from jointid.base.errors import InputError
from jointid.recording.column_lookup import column_index, listed
from jointid.recording.signals import check_signal_name
from jointid.recording.table import RenamedTable, Table
from jointid.recording.wide.finding_joints import columns_of, joint_headers
from jointid.recording.wide.joint_columns import own_columns
from jointid.recording.wide.one_joint import MARK, is_one

Columns = Mapping[str, str | int | None]


class JointTable(RenamedTable):
    """The columns of one joint, with headers without the joint, and the columns of no joint.

    Parameters
    ----------
    table : Table
        Table of several joints.
    joint : str
        Name of the joint from `joints_of`.
    columns : mapping of str to str, int or None
        Same as in `load`; ``{joint}`` in a header stands for the joint.
    extra : mapping of str to str or int
        Name → column of the whole table; it may belong to another joint. Default: none.

    Attributes
    ----------
    columns : dict of str to int or None
        Signal → column of this table, if the header without the joint does not already name this signal.
    side : str
        Side of the gear: "motor" for a motor-side position, otherwise "joint".
    other_sides : dict of str to str
        Signal → its side, if it differs from `side`.
    extra : dict of str to int
        Name → column of this table.

    Raises
    ------
    InputError
        Two columns fit one signal, or a header in `columns` does not exist.
    """

    def __init__(
        self,
        table: Table,
        joint: str,
        columns: Columns,
        extra: Mapping[str, str | int] = MappingProxyType({}),
    ) -> None:
        joints = {each: columns_of(table.headers, each) for each in joints_of(table, columns)}
        owned = {each.index for found in joints.values() for each in found}
        mine = joints.get(joint, [])
        given = {signal: _index(table, column, joint, signal) for signal, column in columns.items()}
        shared = set(range(len(table.headers))) - owned
        found = own_columns(table, mine, sorted(shared), given)
        chosen, self.side, self.other_sides = found.of, found.side, found.other_sides
        own = {name: _extra_index(table, column, joint, name) for name, column in extra.items()}
        wanted = {index for index in (*chosen.values(), *own.values()) if index is not None}
        indices = sorted(shared | {each.index for each in mine} | wanted)
        place = {index: number for number, index in enumerate(indices)}
        without = {each.index: each.header for each in mine}
        super().__init__(
            table,
            [without.get(index, table.headers[index]) for index in indices],
            {table.headers[index]: place[index] for index in indices}
            | {name: place[index] for name, index in table.other_names.items() if index in place},
            indices,
        )
        self.columns = {
            signal: None if index is None else place[index] for signal, index in chosen.items()
        }
        self.extra = {name: place[index] for name, index in own.items()}
        if len(found.asked) == 1 and not {"torque", "motor_torque"} & set(chosen):
            self._own_notes["commanded_torque"] = found.asked[0].pattern
        if table.saved is not None:
            self.saved = {key: table.saved[key] for key in table.saved if key != "robot"}

    def in_whole(self, column: int) -> int:
        """Return the number of a column in the table of all joints."""
        return self._indices[column]


def joints_of(table: Table, columns: Columns | None = None) -> tuple[str, ...]:
    """Return the joints that a table's headers name.

    Parameters
    ----------
    table : Table
    columns : mapping, optional
        Same as in `load`. If no joint from the headers fits the position's ``{joint}``, the joints are the texts at
        this place. Default: none.
    """
    named = tuple(joint_headers(table.headers))
    pattern = columns.get("position") if isinstance(columns, Mapping) else None
    if not isinstance(pattern, str) or pattern.count(MARK) != 1:
        return named
    before, behind = map(re.escape, pattern.strip().split(MARK))
    form = re.compile(f"{before}(.+){behind}", re.IGNORECASE)
    headers = (*table.headers, *table.other_names)
    found = [match[1] for header in headers if (match := form.fullmatch(header.strip()))]
    return named if set(named) & set(found) else tuple(dict.fromkeys(found)) or named


def several_joints(table: Table, columns: Columns | None) -> tuple[str, ...]:
    """Return the joints of a table if these columns cannot mean a single joint; otherwise empty."""
    given = columns or {}
    if is_one(table, given):
        return ()
    if given.get("position") is not None:
        return joints_of(table, given)
    joints = joint_headers(table.headers)
    matrix = all(len(each) == 1 for each in joints.values())
    if matrix and len(joints) == len(table.headers):  # one column of the matrix is the time
        return ()
    return tuple(joints)


def which_joint(table: Table, joints: Sequence[str]) -> InputError:
    """Return the error for a file with several joints if none is named."""
    shown = ", ".join(joints[:12]) + (", ..." if len(joints) > 12 else "")
    return InputError(
        f"the file holds {len(joints)} joints ({shown}), but a recording has only one",
        place=table.header_place,
        remedy=(
            Action(
                "call", {"joint": as_given(joints[0])}, function="load", text="or another joint"
            ),
            Action("call", {"joints": "all"}, function="load_robot", text="for all of them"),
        ),
    )


def as_given(joint: str) -> str | int:
    """Return a joint's name for a call: numbers as int."""
    return int(joint) if joint.isdigit() and str(int(joint)) == joint else joint


def _index(table: Table, column: object, joint: str, signal: str) -> int | None:
    check_signal_name(signal, "columns")
    if column is None:
        return None
    if isinstance(column, str) and MARK in column:
        column = column.replace(MARK, joint)
    return column_index(table, column, f"columns.{signal}")


def _extra_index(table: Table, column: str | int, joint: str, name: str) -> int:
    header = column.replace(MARK, joint) if isinstance(column, str) else column
    return column_index(table, header, f"extra.{name}")


def nothing_named(table: Table, joint: object, argument: str = "joint") -> InputError:
    """Return the error for a named joint in a file without joints in its headers."""
    from jointid.recording.blocks import OF_BLOCKS

    return InputError(
        f"no header names the position of a joint; the headers are {listed(table.headers)}",
        argument=argument,
        value=joint,
        place=table.header_place,
        remedy=(
            OF_BLOCKS,
            "headers such as joint1_position, position.1 or elbow.position name a joint",
        ),
    )
