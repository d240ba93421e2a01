"""What a file of messages offers: topics, and the messages of each in the order of the file."""

from collections.abc import Iterator
from typing import Protocol

from jointid.base.values import dataclass

Message = tuple[int, bytes]
"""Log time [ns] and serialised bytes."""


class DamageError(Exception):
    """Bytes that are no message of their type, or a damaged file; the text says which."""


@dataclass(frozen=True, kw_only=True)
class Topic:
    """One topic of a file.

    Attributes
    ----------
    name : str
        E.g. ``"/joint_states"``.
    kind : str
        Message type as ROS 2 writes it, ``"sensor_msgs/msg/JointState"``.
    encoding : str
        ``"cdr"``, ``"ros1"``, ``"json"``, or another one that is not read.
    definition : str
        Text that defines the type; empty if the file has none.
    definition_format : str
        ``"ros2msg"``, ``"ros1msg"``, ``"ros2idl"``, ``"jsonschema"`` or ``""``.
    count : int, optional
        Number of messages. Default: the file does not say.
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
        """All topics, in the order of the file."""

    def messages(self, topic: Topic) -> Iterator[Message]:
        """Yield the messages of a topic; raise `DamageError` where the file is damaged."""

    @property
    def incomplete(self) -> str:
        """Why the file ends early, known when the messages were read; empty if it does not."""
