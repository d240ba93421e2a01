"""Checks of a recording's attributes other than signals: kind, torque hold, metadata and truth."""

import json
from collections.abc import Mapping
from types import MappingProxyType
from typing import Any

from jointid.base.errors import InputError
from jointid.recording.signals import KINDS


def check_kind(kind: object) -> None:
    """Raise `InputError` for an unknown kind of joint."""
    if kind not in KINDS:
        raise InputError("revolute or prismatic is expected", argument="kind", value=kind)


def check_torque_hold(torque_hold: object) -> None:
    """Raise `InputError` for an unknown interpolation of the torque between samples."""
    if torque_hold not in (None, "zoh", "linear"):
        raise InputError(
            "zoh (held between samples) or linear is expected; if neither is known, leave torque_hold out",
            argument="torque_hold",
            value=torque_hold,
        )


def check_attributes(kind: object, torque_hold: object, name: object, derived: object) -> None:
    """Raise `InputError` for an attribute of a wrong type."""
    check_kind(kind)
    check_torque_hold(torque_hold)
    if not isinstance(name, str):
        raise InputError("a string is expected", argument="name", value=name)
    if not isinstance(derived, bool):
        raise InputError("true or false is expected", argument="velocity_derived", value=derived)


def json_mapping(argument: str, mapping: Mapping[str, Any]) -> Mapping[str, Any]:
    """Return a read-only copy of a mapping, as it is after a round trip through JSON.

    Raises
    ------
    InputError
        The argument is not a mapping, a key is not a string, or JSON cannot represent a value.
    """
    if not isinstance(mapping, Mapping):
        raise InputError("a mapping is expected", argument=argument, value=mapping)
    for key in mapping:
        if not isinstance(key, str):
            raise InputError(f"the key {key!r} is not a string", argument=argument)
    try:
        text = json.dumps(dict(mapping), allow_nan=False)
    except (TypeError, ValueError, RecursionError):
        unusable = [key for key, value in mapping.items() if not _is_json(value)]
        raise InputError(
            "a JSON value is expected (text, finite number, list, mapping)",
            argument=f"{argument}.{unusable[0]}" if unusable else argument,
        ) from None
    return MappingProxyType(json.loads(text))


def _is_json(value: object) -> bool:
    try:
        json.dumps(value, allow_nan=False)
    except (TypeError, ValueError, RecursionError):
        return False
    return True
