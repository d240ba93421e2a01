"""One joint of a table with several: its columns and the shared ones, as a table of a single joint."""

import re
from collections.abc import Mapping, Sequence
from types import MappingProxyType
from typing import Any

import numpy.typing as npt

from jointid.base.advice import Action
from jointid.base.errors import InputError
from jointid.recording.column_lookup import column_index, listed
from jointid.recording.headers import ALIASES, parsed
from jointid.recording.signals import FloatArray, check_signal_name, closest, dimensions
from jointid.recording.table import Table, first_cell, raw_values
from jointid.recording.wide.finding_joints import JointHeader, joint_headers
from jointid.recording.wide.words import JOINT, MOTOR

Columns = Mapping[str, str | int | None]
_MARK = "{joint}"
_NEEDED = ("position", "velocity", "torque", "motor_torque")


class JointTable:
    """The columns of one joint, their headers without the joint, and those that no joint owns.

    Parameters
    ----------
    table : Table
        With several joints.
    joint : str
        As `joints_of` names it.
    columns : mapping of str to str, int or None
        As given to `load`; ``{joint}`` in a header stands for the joint.
    extra : mapping of str to str or int
        Name → column of the whole table, also one of another joint. Default: none.

    Attributes
    ----------
    columns : dict of str to int or None
        Signal → column of this table; what the headers do not say otherwise.
    side : str
        "motor" if position, velocity and torque are those of the motor, else "joint".
    extra : dict of str to int
        Name → column of this table.

    Raises
    ------
    InputError
        Two columns could be the same signal, or a header in `columns` does not exist.
    """

    def __init__(
        self,
        table: Table,
        joint: str,
        columns: Columns,
        extra: Mapping[str, str | int] = MappingProxyType({}),
    ) -> None:
        self._table = table
        joints = joint_headers(table.headers)
        owned = {each.index for found in joints.values() for each in found}
        mine = joints.get(joint, [])
        given = {signal: _index(table, column, joint, signal) for signal, column in columns.items()}
        chosen, self.side = _chosen(table, mine, given)
        own = {name: _extra_index(table, column, joint, name) for name, column in extra.items()}
        wanted = {index for index in (*chosen.values(), *own.values()) if index is not None}
        shared = set(range(len(table.headers))) - owned
        self._indices = sorted(shared | {each.index for each in mine} | wanted)
        place = {index: number for number, index in enumerate(self._indices)}
        without = {each.index: each.header for each in mine}
        self.source = table.source
        self.header_place = table.header_place
        self.headers = tuple(without.get(index, table.headers[index]) for index in self._indices)
        self.columns = {
            signal: None if index is None else place[index] for signal, index in chosen.items()
        }
        self.extra = {name: place[index] for name, index in own.items()}
        self.other_names = {table.headers[index]: place[index] for index in self._indices} | {
            name: place[index] for name, index in table.other_names.items() if index in place
        }
        self.notes: Mapping[str, Any] = getattr(table, "notes", {})
        saved = table.saved
        self.saved: Mapping[str, Any] | None = (
            None if saved is None else {key: saved[key] for key in saved if key != "robot"}
        )

    def numbers(self, columns: Sequence[int]) -> list[FloatArray]:
        """Return columns as numbers."""
        return self._table.numbers([self._indices[column] for column in columns])

    def text(self, column: int) -> list[str]:
        """Return a column as text."""
        return self._table.text(self._indices[column])

    def first_cell(self, column: int) -> str:
        """Return the first cell of a column as it stands in the file."""
        return first_cell(self._table, self._indices[column])

    def raw(self, column: int) -> npt.NDArray[Any] | None:
        """Return a column as the file has it."""
        return raw_values(self._table, self._indices[column])

    def place(self, column: int, row: int) -> str:
        """Return where a cell is."""
        return self._table.place(self._indices[column], row)


def joints_of(table: Table) -> tuple[str, ...]:
    """Return the joints that a table's headers name."""
    return tuple(joint_headers(table.headers))


def joint_named(joint: object, joints: Sequence[str], place: str, argument: str = "joint") -> str:
    """Return the joint that a name or a number names.

    Parameters
    ----------
    joint : str or int
        A name, or a joint's number: 3 is "3", "03", or the only name with the number 3, "joint_3".
    joints : sequence of str
    place : str
        For messages.
    argument : str
        What it was given for.

    Raises
    ------
    InputError
        There is no such joint.
    """
    if isinstance(joint, bool) or not isinstance(joint, str | int):
        raise InputError(
            "a joint's name or number is expected", argument=argument, value=joint, place=place
        )
    text = str(joint)
    if text in joints:
        return text
    if text.isdigit():
        numbered = [
            each for each in joints if list(map(int, re.findall(r"\d+", each))) == [int(text)]
        ]
        if len(numbered) == 1:
            return numbered[0]
    near = closest(text, joints)
    raise InputError(
        f"there is no such joint; {'the only one is' if len(joints) == 1 else 'there are'} "
        f"{', '.join(joints) or 'none'}",
        argument=argument,
        value=joint,
        place=place,
        remedy=f"did you mean {near!r}" if near and not text.isdigit() else (),
    )


def several_joints(table: Table, columns: Columns | None) -> tuple[str, ...]:
    """Return the joints of a table that no call with these columns could mean as one; empty if it could."""
    given = columns or {}
    if given.get("position") is not None:
        return ()
    if any(ALIASES.get(parsed(header)[0]) == "position" for header in table.headers):
        return ()
    joints = joint_headers(table.headers)
    if sum(map(len, joints.values())) == len(table.headers):  # a matrix: one of them is the time
        return ()
    return tuple(joints)


def which_joint(table: Table, joints: Sequence[str]) -> InputError:
    """Return the error for a file with several joints of which none is named."""
    shown = ", ".join(joints[:12]) + (", ..." if len(joints) > 12 else "")
    return InputError(
        f"the file holds {len(joints)} joints ({shown}), and a recording has one",
        place=table.header_place,
        remedy=(
            Action("call", {"joint": _as_given(joints[0])}, function="load", text="or another one"),
            Action("call", {"joints": "all"}, function="load_robot", text="for all of them"),
        ),
    )


def _as_given(joint: str) -> str | int:
    return int(joint) if joint.isdigit() and str(int(joint)) == joint else joint


def _index(table: Table, column: object, joint: str, signal: str) -> int | None:
    check_signal_name(signal, "columns")
    if column is None:
        return None
    if isinstance(column, str) and _MARK in column:
        column = column.replace(_MARK, joint)
    return column_index(table, column, f"columns.{signal}")


def _extra_index(table: Table, column: str | int, joint: str, name: str) -> int:
    header = column.replace(_MARK, joint) if isinstance(column, str) else column
    return column_index(table, header, f"extra.{name}")


def _chosen(
    table: Table, mine: list[JointHeader], given: Mapping[str, int | None]
) -> tuple[dict[str, int | None], str]:
    """Return the column of each signal, and the side of the gear that they are on.

    What the joint's side has is taken before what the motor's has; velocity and torque are those of the
    position's side. A link's encoder is the position where there is no other.
    """
    used = set(given.values())
    meant: dict[str, list[JointHeader]] = {}
    for each in mine:
        if each.meaning and each.index not in used and _readable(each):
            meant.setdefault(each.meaning.signal, []).append(each)
    position = _of_column(mine, given.get("position"))
    if position is not None:
        side = position.meaning.side if position.meaning else JOINT
    else:
        here = meant.get("position", [])
        if not here and "link_position" in meant:
            meant["position"] = here = meant.pop("link_position")
        at_joint = any(each.meaning and each.meaning.side == JOINT for each in here)
        side = JOINT if at_joint or not here else MOTOR
    chosen: dict[str, int | None] = dict(given)
    for signal, found in meant.items():
        name = "torque" if signal == "motor_torque" and side == MOTOR else signal
        if name in given or signal in given or (name != signal and "torque" in meant):
            continue
        fitting = found
        if signal in ("position", "velocity", "reference"):
            fitting = [each for each in found if each.meaning and each.meaning.side == side]
        if fitting:
            chosen[name] = _only(table, name, fitting).index
    return chosen, side


def _readable(column: JointHeader) -> bool:
    """Whether a column's unit is one of its signal; of what nobody needs another one blocks nothing."""
    if column.meaning is None or column.meaning.signal in _NEEDED:
        return True
    _, unit, unknown = parsed(column.header)
    known = dimensions(column.meaning.signal, None)
    return not unknown and (unit is None or unit.dimension in known)


def _of_column(mine: list[JointHeader], index: int | None) -> JointHeader | None:
    return next((each for each in mine if each.index == index), None)


def _only(table: Table, signal: str, found: list[JointHeader]) -> JointHeader:
    ranks = [each.meaning.rank for each in found if each.meaning]
    best = [each for each, rank in zip(found, ranks, strict=True) if rank == min(ranks)]
    if len(best) == 1:
        return best[0]
    names = " and ".join(f"{table.headers[each.index]!r}" for each in best[:3])
    raise InputError(
        f"{names} could both be the {signal} of joint {best[0].joint}",
        place=table.header_place,
        remedy=tuple(
            Action("call", {"columns": {signal: each.pattern}}, function="load")
            for each in best[:2]
        ),
    )


def nothing_named(table: Table, joint: object) -> InputError:
    """Return the error for a joint in a file whose headers name none."""
    return InputError(
        f"the headers name no joints with a position; they are {listed(table.headers)}",
        argument="joint",
        value=joint,
        place=table.header_place,
        remedy="headers such as joint1_position, position.1 or elbow.position name a joint",
    )
