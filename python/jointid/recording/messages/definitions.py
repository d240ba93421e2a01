"""Message types: the fields of each, from the definition in the file."""

from collections.abc import Mapping, Sequence
from functools import lru_cache
from typing import Any

from jointid.base.error_text import reason_of
from jointid.recording.messages.topic import DamageError, Topic

_LONGEST = 200_000  # characters of a definition

Field = tuple[str, Any]  # name, and its description in the form of rosbags
Types = Mapping[str, Sequence[Field]]


def normal_kind(kind: str) -> str:
    """Return a type's name as ROS 2 writes it.

    Examples
    --------
    >>> normal_kind("sensor_msgs/JointState")
    'sensor_msgs/msg/JointState'
    """
    package, _, name = kind.partition("/")
    return f"{package}/msg/{name}" if name and "/" not in name else kind


def types_of(topic: Topic) -> Types:
    """Return the fields of a topic's type and of all types inside it.

    Types that the file does not define are taken from the common types of ROS 2.

    Raises
    ------
    DamageError
        The definition cannot be read or is missing.
    """
    return _types(topic.kind, topic.definition, topic.definition_format)


@lru_cache(maxsize=256)
def _types(kind: str, definition: str, form: str) -> Types:
    from rosbags.typesys import get_types_from_idl, get_types_from_msg

    if len(definition) > _LONGEST:
        raise DamageError(f"the definition of {kind} is longer than {_LONGEST} characters")
    known = dict(_common())
    if definition:
        try:
            idl = form == "ros2idl"
            found = get_types_from_idl(definition) if idl else get_types_from_msg(definition, kind)
        # The parser documents no other error, and a file's definition may be anything.
        except Exception as error:
            raise DamageError(
                f"the definition of {kind} cannot be read ({reason_of(error)})"
            ) from None
        known.update({name: fields for name, (_, fields) in found.items()})
    if kind not in known:
        raise DamageError(f"the file does not define its message type {kind}")
    return known


@lru_cache(maxsize=1)
def _common() -> dict[str, Sequence[Field]]:
    from rosbags.typesys import Stores, get_typestore

    return {name: fields for name, (_, fields) in get_typestore(Stores.LATEST).fielddefs.items()}
