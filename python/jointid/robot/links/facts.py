"""Facts of a robot that its URDF does not contain, from a file."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from jointid.base.errors import InputError
from jointid.base.schema import Plain, TableOf
from jointid.base.toml_file import read_toml
from jointid.joint.checks import suggestion

KEYS = (
    *("joints", "gear_ratios", "couplings", "rotor_inertias", "zero_offsets", "zero_offsets_deg"),
    *("gravity", "side", "torque_constants", "torque_scales", "directions", "models", "drive"),
)

_FACTS = TableOf(Plain())  # `Robot` checks each value in detail


def read_facts(path: Path) -> dict[str, Any]:
    """Return the arguments of `Robot.from_urdf` from a facts file, or name the file and the fault in it."""
    try:
        found = _FACTS.read(read_toml(path), "")
    except InputError as error:
        raise (error if error.place.startswith(str(path)) else error.at(path.name)) from None
    for key in found:
        if key not in KEYS:
            raise InputError(
                f"there is no such key; {suggestion(key, KEYS)}", argument=key, place=path.name
            )
    _check_tables(found, place=path.name)
    if isinstance(found.get("joints"), dict):
        found |= _of_joints(found.pop("joints"), path.name)
    if found.get("joints") == []:
        raise InputError(
            "a list of names is expected", argument="joints", value=[], place=path.name
        )
    if "zero_offsets_deg" in found:
        if "zero_offsets" in found:
            raise InputError(
                "zero_offsets states the same offsets in radians; give only one of these keys",
                argument="zero_offsets_deg",
                value=found["zero_offsets_deg"],
                place=path.name,
            )
        degrees = found.pop("zero_offsets_deg")
        try:
            found["zero_offsets"] = [float(each) * 0.017453292519943295 for each in degrees]
        except (OverflowError, TypeError, ValueError):
            raise InputError(
                "numbers are expected", argument="zero_offsets_deg", value=degrees, place=path.name
            ) from None
    # TOML has no null: "free" means an inertia that is identified.
    rotors = found.get("rotor_inertias")
    if isinstance(rotors, list):
        found["rotor_inertias"] = [None if each == "free" else each for each in rotors]
    return found


def _check_tables(table: dict[str, Any], place: str, header: str = "") -> None:
    """Refuse a list or word of the robot below a table's header, because it belongs to that table."""
    for key, value in table.items():
        if isinstance(value, dict):
            _check_tables(value, place, f"{header}.{key}".lstrip("."))
        elif header and key in KEYS and isinstance(value, list | str):
            raise InputError(
                f"this line is below [{header}] and belongs to that table",
                argument=f"{header}.{key}",
                place=place,
                remedy=f"write {key} above the first table",
            )


def _of_joints(tables: dict[str, Any], place: str) -> dict[str, Any]:
    """Return facts of single joints; facts that are not named keep their default."""
    models = {}
    for name, table in tables.items():
        if not isinstance(table, dict) or set(table) != {"model"}:
            raise InputError(
                "a table with the joint's model is expected",
                argument=f"joints.{name}",
                value=table,
                place=place,
            )
        models[name] = table["model"]
    return {"models": models}
