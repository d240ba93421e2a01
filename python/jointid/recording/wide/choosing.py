"""One joint of any table: what `load` reads."""

from collections.abc import Callable, Collection, Mapping
from dataclasses import replace

from jointid.base.advice import Action
from jointid.base.errors import InputError
from jointid.recording.extra import named_extra
from jointid.recording.table import Table
from jointid.recording.wide.joint_names import joint_named
from jointid.recording.wide.joint_table import (
    JointTable,
    as_given,
    joints_of,
    nothing_named,
    several_joints,
    which_joint,
)
from jointid.recording.wide.one_joint import OneJoint
from jointid.recording.wide.reading_back import saved_robot

_TRIED = 2  # parts of a file that are opened to look for several joints


def chosen_joint(
    table: Table,
    joint: str | int | None,
    columns: Mapping[str, str | int | None] | None,
    extra: Collection[str] | Mapping[str, str | int] | None = None,
) -> OneJoint:
    """Return one joint of a table with joints in its headers; the table itself if it names none.

    Parameters
    ----------
    table : Table
    joint : str, int or None
        Name or number of the joint. None: the only joint.
    columns : mapping or None
        Same as in `load`.
    extra : collection, mapping or None
        Same as in `load`; may name columns of other joints.

    Raises
    ------
    InputError
        There is no such joint, the table has several joints and none is named, or two columns fit one signal.
    """
    if joint is None:
        several = several_joints(table, columns)
        if not several:
            return OneJoint(table=table, columns=columns, extra=extra)
        if len(several) > 1:
            raise which_joint(table, several)
        joint = several[0]
    joints = joints_of(table, columns)
    if not joints:
        raise nothing_named(table, joint)
    name = joint_named(joint, joints, table.header_place, function="load")
    found = JointTable(table, name, columns or {}, named_extra(extra))
    one = OneJoint(
        table=found,
        columns=found.columns,
        extra=found.extra,
        side=found.side,
        other_sides=found.other_sides,
        joint=name,
    )
    saved = saved_robot(table)
    if saved is None or name not in saved.names:
        return one
    ratio = None if saved.gear_ratio is None else saved.gear_ratio[saved.names.index(name)]
    return replace(one, side=saved.side, gear_ratio=ratio)


def also_joints(
    error: InputError,
    opened: Callable[..., Table],
    columns: Mapping[str, str | int | None] | None,
) -> InputError:
    """Add a joint to an error's proposed parts of a file, if that part holds several joints.

    Otherwise the proposed call would also be refused.

    Parameters
    ----------
    error : InputError
        The error that the file cannot be opened without a topic or a group.
    opened : callable
        Returns the table of a part, by its argument.
            columns : mapping or None
                Same as in `load`.
    """
    remedies: list[str | Action] = list(error.remedy)
    for k, action in enumerate(remedies[:_TRIED]):
        if not isinstance(action, Action) or not {*action.arguments} <= {"topic", "group"}:
            continue
        try:
            several = several_joints(opened(**action.arguments), columns)
        except InputError:
            continue
        if len(several) > 1:
            arguments = {**action.arguments, "joint": as_given(several[0])}
            remedies[k] = Action("call", arguments, "or another joint", "load")
    return InputError(
        error.reason,
        argument=error.argument,
        value=error.value,
        place=error.place,
        remedy=tuple(remedies),
    )
