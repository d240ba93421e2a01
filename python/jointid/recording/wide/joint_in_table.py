"""The joint that `load` reads from any table; a table of one joint needs few other files of this folder."""

from __future__ import annotations

from collections.abc import Collection, Mapping

from jointid.recording.table import Table
from jointid.recording.wide.one_joint import OneJoint, is_one


def joint_of_table(
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
    if joint is None and (not isinstance(columns or {}, Mapping) or is_one(table, columns)):
        return OneJoint(table=table, columns=columns, extra=extra)
    # Most files hold one joint, and these are as many modules as all that read them.
    from jointid.recording.wide.choosing import chosen_joint

    return chosen_joint(table, joint, columns, extra)
