"""Interface of a file of messages: its topics, and the messages of each in file order."""

from collections.abc import Iterator
from typing import Protocol

from jointid.base.values import dataclass

Message = tuple[int, bytes]
"""Log time [ns] and serialised bytes."""


class DamageError(Exception):
    """Bytes that are not a message of their type, or a damaged file; the text says which."""


@dataclass(frozen=True, kw_only=True)
class Topic:
    """One topic of a file.

    Attributes
    ----------
    name : str
        Name of the topic, e.g. ``"/joint_states"``.
    kind : str
        Message type in the form of ROS 2, ``"sensor_msgs/msg/JointState"``.
    encoding : str
        ``"cdr"``, ``"ros1"``, ``"json"``, or another one that is not read.
    definition : str
        Text that defines the type; empty if the file has none.
    definition_format : str
        ``"ros2msg"``, ``"ros1msg"``, ``"ros2idl"``, ``"jsonschema"`` or ``""``.
    count : int, optional
        Number of messages. Default: unknown.
    """

    name: str
    kind: str
    encoding: str
    definition: str = ""
    definition_format: str = ""
    count: int | None = None


class Source(Protocol):
    """A file of messages."""

    @property
    def topics(self) -> tuple[Topic, ...]:
        """Return all topics, in file order."""

    def messages(self, topic: Topic) -> Iterator[Message]:
        """Yield the messages of a topic; raise `DamageError` where the file is damaged."""

    @property
    def incomplete(self) -> str:
        """Reason why the file ends early, known after the messages are read; empty if it is complete."""
