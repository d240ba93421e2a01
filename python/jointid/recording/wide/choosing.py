"""One joint of any table: what `load` reads."""

from collections.abc import Collection, Mapping
from dataclasses import dataclass, replace

from jointid.recording.extra import named_extra
from jointid.recording.table import Table
from jointid.recording.wide.joint_names import joint_named
from jointid.recording.wide.joint_table import (
    JointTable,
    joints_of,
    nothing_named,
    several_joints,
    which_joint,
)
from jointid.recording.wide.reading_back import saved_robot
from jointid.recording.wide.words import JOINT


@dataclass(frozen=True, kw_only=True)
class OneJoint:
    """A table of one joint.

    Attributes
    ----------
    table : Table
    columns : mapping of str to str, int or None, or None
        As `read_contents` takes them.
    extra : collection, mapping or None
        As `read_contents` takes it.
    side : str
        Of the gear: "joint" or "motor".
    joint : str
        Its name; empty for a table without names of joints.
    gear_ratio : float or None
        As saved; None: not known.
    """

    table: Table
    columns: Mapping[str, str | int | None] | None
    extra: Collection[str] | Mapping[str, str | int] | None = None
    side: str = JOINT
    joint: str = ""
    gear_ratio: float | None = None


def one_joint(
    table: Table,
    joint: str | int | None,
    columns: Mapping[str, str | int | None] | None,
    extra: Collection[str] | Mapping[str, str | int] | None = None,
) -> OneJoint:
    """Return one joint of a table; the table itself if it is of one joint.

    Parameters
    ----------
    table : Table
    joint : str, int or None
        None: the only one.
    columns : mapping or None
        As given to `load`.
    extra : collection, mapping or None
        As given to `load`; also columns of other joints.

    Raises
    ------
    InputError
        There is no such joint, or several and none is named; two columns could be the same signal.
    """
    if joint is None:
        several = several_joints(table, columns) if isinstance(columns or {}, Mapping) else ()
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
        table=found, columns=found.columns, extra=found.extra, side=found.side, joint=name
    )
    saved = saved_robot(table)
    if saved is None or name not in saved.names:
        return one
    ratio = None if saved.gear_ratio is None else saved.gear_ratio[saved.names.index(name)]
    return replace(one, side=saved.side, gear_ratio=ratio)
