"""Meaning of a message's numbers: joint and signal, or a field by its name."""

from collections.abc import Mapping, Sequence

from jointid.recording.messages.topic import DamageError

Path = tuple[str | int, ...]

# Field with the joints' names → fields of each signal's values; the first one with values counts.
_SIGNALS: dict[str, dict[str, tuple[tuple[str, ...], ...]]] = {
    "JointState": {
        "position": (("position",),),
        "velocity": (("velocity",),),
        "effort": (("effort",),),
    },
    "JointTrajectoryControllerState": {
        "position": (("feedback", "positions"), ("actual", "positions")),
        "velocity": (("feedback", "velocities"), ("actual", "velocities")),
        "effort": (("feedback", "effort"), ("actual", "effort"), ("output", "effort")),
        "reference": (("reference", "positions"), ("desired", "positions")),
    },
}
_NAMES = {"JointState": "name", "JointTrajectoryControllerState": "joint_names"}
_LISTED = {
    # One record per joint: the list, its name, and the values in it.
    "JointStates": ("joints", "name"),
}
JOINT_KINDS = (*_SIGNALS, "DynamicJointState", *_LISTED)
_UNITS = {
    "revolute": {"position": "rad", "velocity": "rad/s", "effort": "Nm", "reference": "rad"},
    "prismatic": {"position": "m", "velocity": "m/s", "effort": "N", "reference": "m"},
}
_STAMPS = ("header", "stamp", "timestamp")


def may_name(path: Path) -> bool:
    """Whether a text at this place may name a joint: it is in a list, or its field is called a name.

    Only these texts determine the meaning of the numbers; other texts, such as frame names, are ignored.
    """
    return path[-1] == "name" or isinstance(path[-1], int)


def is_joint_kind(kind: str) -> bool:
    """Whether messages of this type name joints."""
    return short(kind) in JOINT_KINDS


def short(kind: str) -> str:
    """Return the name of a type without its package."""
    return kind.replace(".", "/").rpartition("/")[2]


def unit_of(signal: str, kind: str) -> str:
    """Return the unit of a joint's signal in a message: SI, by REP 103; empty for any other field."""
    return _UNITS[kind].get(signal, "")


Column = tuple[str, str]
"""A joint's name or ""; and a signal or the field's path."""


def stamp_of(numbers: Sequence[Path]) -> tuple[int, int] | None:
    """Return the indices of the stamp in a message, seconds and nanoseconds; None if there is no stamp."""
    where = {path: index for index, path in enumerate(numbers)}
    for place in (("header", "stamp"), ("timestamp",), ("stamp",)):
        for seconds, rest in (("sec", "nanosec"), ("sec", "nsec"), ("secs", "nsecs")):
            if (*place, seconds) in where and (*place, rest) in where:
                return where[*place, seconds], where[*place, rest]
    return None


def columns_of(kind: str, numbers: Sequence[Path], names: Mapping[Path, str]) -> dict[Column, int]:
    """Return column → index of its number, for one layout.

    Parameters
    ----------
    kind : str
        Type of the messages.
    numbers : sequence of paths
    names : mapping of path to str
        Texts in the message.

    Raises
    ------
    DamageError
        The numbers do not fit the names, or a name occurs twice.
    """
    where = {path: index for index, path in enumerate(numbers)}
    type_name = short(kind)
    if type_name in _SIGNALS:
        return _by_lists(type_name, where, names)
    if type_name == "DynamicJointState":
        return _by_interfaces(where, names)
    if type_name in _LISTED:
        return _by_records(type_name, where, names)
    return {
        ("", ".".join(map(str, path))): index
        for path, index in where.items()
        if path[0] not in _STAMPS
    }


def _by_lists(
    type_name: str, where: Mapping[Path, int], names: Mapping[Path, str]
) -> dict[Column, int]:
    listed = [
        name for path, name in names.items() if path[0] == _NAMES[type_name] and len(path) == 2
    ]
    lengths: dict[Path, int] = {}
    for path in where:
        if isinstance(path[-1], int):
            lengths[path[:-1]] = max(lengths.get(path[:-1], 0), path[-1] + 1)
    found: dict[Column, int] = {}
    for signal, places in _SIGNALS[type_name].items():
        place = next((place for place in places if lengths.get(place)), None)
        if place is None:
            continue
        joints = listed or [f"joint_{number}" for number in range(1, lengths[place] + 1)]
        if lengths[place] != len(joints):
            raise DamageError(
                f"it has {len(joints)} joints, but {lengths[place]} values of {signal}"
            )
        for number, joint in enumerate(joints):
            _enter(found, joint, signal, where[*place, number])
    return found


def _by_interfaces(where: Mapping[Path, int], names: Mapping[Path, str]) -> dict[Column, int]:
    found: dict[Column, int] = {}
    for path, interface in names.items():
        if len(path) == 4 and path[0] == "interface_values" and path[2] == "interface_names":
            value = where.get(("interface_values", path[1], "values", path[3]))
            joint = names.get(("joint_names", path[1]))
            if value is None or joint is None:
                raise DamageError("its interface values do not match its joint names")
            _enter(found, joint, interface, value)
    return found


def _by_records(
    type_name: str, where: Mapping[Path, int], names: Mapping[Path, str]
) -> dict[Column, int]:
    records, label = _LISTED[type_name]
    found: dict[Column, int] = {}
    for path, index in where.items():
        if len(path) == 3 and path[0] == records:
            joint = names.get((records, path[1], label))
            if joint is None:
                raise DamageError("a joint has no name")
            _enter(found, joint, str(path[2]), index)
    return found


def _enter(found: dict[Column, int], joint: str, signal: str, index: int) -> None:
    if (joint, signal) in found:
        raise DamageError(f"it has the joint {joint!r} twice")
    found[joint, signal] = index
