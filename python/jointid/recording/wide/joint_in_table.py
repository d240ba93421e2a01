"""The joint that `load` reads from any table; a table of one joint imports few other modules of this folder."""

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
    """Return one joint of a table; the table itself if it has only one joint.

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
    if joint is None and (not isinstance(columns or {}, Mapping) or is_one(table, columns)):
        return OneJoint(table=table, columns=columns, extra=extra)
    # Import late: most files hold one joint, and these imports would double the number of modules.
    from jointid.recording.wide.choosing import chosen_joint

    return chosen_joint(table, joint, columns, extra)
