"""Angles in a joint file: read as rad or "60deg", and kept in their written form."""

from collections.abc import Mapping
from typing import Any

from jointid.base.errors import InputError
from jointid.joint.angles import ANGLE_EXPECTED, in_radians, text_in

_ANGLES = {"link": ("angle",), "limits": ("position", "velocity")}


def with_angles(
    table: dict[str, Any], name: str, document: Mapping[str, Any], source: str
) -> dict[str, Any]:
    """Return a table with its angles in rad."""
    for key in _angle_keys(document, name):
        if key in table:
            table[key] = in_radians(table[key])
            if (text := text_in(table[key])) is not None:
                place = f"{source}: [{name}]"
                raise InputError(ANGLE_EXPECTED, argument=key, value=text, place=place)
    return table


def keep_angles(before: Mapping[str, Any], wanted: dict[str, Any]) -> None:
    """Keep the text of each angle in the file that does not change."""
    for table in _ANGLES:
        for key in _angle_keys(wanted, table):
            text = before.get(table, {}).get(key)
            if key in wanted.get(table, {}) and in_radians(text) == wanted[table][key]:
                wanted[table][key] = text


def _angle_keys(document: Mapping[str, Any], name: str) -> tuple[str, ...]:
    """Return the keys of a table that are angles; the limits of a prismatic joint are not."""
    slides = document.get("kind", "revolute") != "revolute"
    return () if slides and name == "limits" else _ANGLES.get(name, ())
