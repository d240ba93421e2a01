"""The one joint of a table that `load` reads."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import field
from typing import Any

from jointid.base.values import dataclass
from jointid.recording.headers import ALIASES, parsed
from jointid.recording.sides import at_stated_sides
from jointid.recording.table import Table

MARK = "{joint}"
"""Placeholder for the joint in a header of `columns`."""


@dataclass(frozen=True, kw_only=True)
class OneJoint:
    """A table of one joint.

    Attributes
    ----------
    table : Table
    columns : mapping of str to str, int or None, or None
        Columns for `read_contents`.
    extra : collection, mapping or None
        Extra signals for `read_contents`.
    side : str
        Side of the gear of the position: "joint" or "motor".
    other_sides : mapping of str to str
        Signal → its side, if it differs from `side`.
    joint : str
        Name of the joint; empty for a table without joint names.
    gear_ratio : float or None
        Saved gear ratio. None: not known.
    """

    table: Table
    columns: Mapping[str, str | int | None] | None
    extra: Collection[str] | Mapping[str, str | int] | None = None
    side: str = "joint"
    other_sides: Mapping[str, str] = field(default_factory=dict)
    joint: str = ""
    gear_ratio: float | None = None


def is_one(table: Table, columns: Mapping[str, str | int | None] | None) -> bool:
    """Whether a table has a position without a joint's name, by its headers or by `columns`.

    Parameters
    ----------
    table : Table
    columns : mapping or None
        Same as in `load`.
    """
    position = (columns or {}).get("position")
    if position is not None:
        return not isinstance(position, str) or MARK not in position
    return any(ALIASES.get(parsed(header)[0]) == "position" for header in table.headers)


def of_joint(
    fields: dict[str, Any], one: OneJoint, gear_ratio: float | None, side: Mapping[str, str] | None
) -> dict[str, Any]:
    """Return the arguments of `Recording` on the joint side: see `load` for `gear_ratio` and `side`."""
    if not one.joint and gear_ratio is None and not side:
        return fields
    found = at_stated_sides(
        fields,
        gear_ratio,
        side,
        side=one.side,
        other_sides=one.other_sides,
        place=one.table.header_place,
    )
    if one.joint:
        found["metadata"] = {**found["metadata"], "joint": one.joint}
    return found
