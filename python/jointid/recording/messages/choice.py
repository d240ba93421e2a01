"""Choice of the topic to read: the named one, or the only one with joints."""

from collections.abc import Sequence
from pathlib import Path

from jointid.base.advice import Action
from jointid.base.errors import InputError
from jointid.recording.messages.collecting import READ
from jointid.recording.messages.joints import is_joint_kind, short
from jointid.recording.messages.topic import Topic
from jointid.recording.signals import closest

_SHOWN = 12


def chosen_topic(path: Path, topics: Sequence[Topic], name: str | None, incomplete: str) -> Topic:
    """Return the topic to read.

    Parameters
    ----------
    path : Path
    topics : sequence of Topic
        All topics of the file.
    name : str or None
        Name of the topic. None: the only topic with joints.
    incomplete : str
        Reason why the file ends early; empty if it is complete.

    Raises
    ------
    InputError
        There is no such topic, or no topic or several topics hold joints.
    """
    if not topics:
        why = f": {incomplete}" if incomplete else ""
        raise InputError(f"no topics are found{why}", place=str(path))
    if name is not None:
        return _named(path, topics, name)
    filled = [topic for topic in topics if topic.count != 0] or list(topics)
    joints = [topic for topic in filled if is_joint_kind(topic.kind)]
    best = [topic for topic in joints if short(topic.kind) == "JointState"] or joints
    read = [topic for topic in best if topic.encoding in READ] or best
    if len(read) == 1:
        return read[0]
    if read:
        raise InputError(
            f"{len(read)} topics hold joints: {_listed(read)}",
            place=str(path),
            remedy=tuple(_load(topic) for topic in read[:_SHOWN]),
        )
    raise InputError(
        f"no topic holds joints, such as one of type sensor_msgs/JointState; topics are {_listed(filled)}",
        place=str(path),
        remedy=_load(filled[0], "with this or another topic; state the topic's columns"),
    )


def _named(path: Path, topics: Sequence[Topic], name: str) -> Topic:
    for slashes in ("", "/"):  # joint_states also finds /joint_states
        found = [each for each in topics if _bare(each.name, slashes) == _bare(name, slashes)]
        if found:
            return max(found, key=lambda topic: (is_joint_kind(topic.kind), topic.encoding in READ))
    close = closest(name, [topic.name for topic in topics])
    raise InputError(
        "no such topic",
        argument="topic",
        value=name,
        place=str(path),
        remedy=f"did you mean {close!r}" if close else f"topics are {_listed(topics)}",
    )


def _bare(name: str, slashes: str) -> str:
    return name.strip(slashes) if slashes else name


def _load(topic: Topic, text: str = "") -> Action:
    return Action("call", {"topic": topic.name}, function="load", text=text)


def _listed(topics: Sequence[Topic]) -> str:
    shown = ", ".join(f"{topic.name} ({topic.kind or topic.encoding})" for topic in topics[:_SHOWN])
    rest = len(topics) - _SHOWN
    return f"{shown} and {rest} more" if rest > 0 else shown
