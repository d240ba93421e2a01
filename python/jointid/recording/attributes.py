"""What a recording says of itself besides its signals, and what makes it usable."""

import json
from collections.abc import Mapping
from types import MappingProxyType
from typing import Any

from jointid.base.errors import InputError
from jointid.recording.signals import KINDS


def check_kind(kind: object) -> None:
    """Refuse a kind of joint that does not exist."""
    if kind not in KINDS:
        raise InputError(f"kind is {kind!r}; 'revolute' or 'prismatic' is expected")


def check_torque_hold(torque_hold: object) -> None:
    """Refuse a way of holding the torque that does not exist."""
    if torque_hold not in (None, "zoh", "linear"):
        raise InputError(
            f"torque_hold is {torque_hold!r}; 'zoh' (held between samples), 'linear' or None "
            "(not known) is expected"
        )


def json_mapping(argument: str, mapping: Mapping[str, Any]) -> Mapping[str, Any]:
    """Return a read-only copy of a mapping, as JSON would give it back, or refuse it."""
    if not isinstance(mapping, Mapping):
        raise InputError(f"{argument} is a {type(mapping).__name__}; a mapping is expected")
    for key in mapping:
        if not isinstance(key, str):
            raise InputError(f"{argument}: the key {key!r} is not a string")
    try:
        return MappingProxyType(json.loads(json.dumps(dict(mapping), allow_nan=False)))
    except (TypeError, ValueError, RecursionError):
        culprit = next((key for key, value in mapping.items() if not _holds(value)), "all of it")
        raise InputError(
            f"{argument}: {culprit!r} holds no JSON value (text, finite number, list, mapping)"
        ) from None


def _holds(value: object) -> bool:
    try:
        json.dumps(value, allow_nan=False)
    except (TypeError, ValueError, RecursionError):
        return False
    return True
