"""ROS 1 bags: records are read in order, so that a bag without its index is also readable."""

import struct
from collections.abc import Iterator
from pathlib import Path
from typing import BinaryIO

from jointid.base.error_text import reason_of
from jointid.base.errors import InputError
from jointid.base.unpacking import Room
from jointid.recording.messages.definitions import normal_kind
from jointid.recording.messages.packed import of_lz4
from jointid.recording.messages.topic import DamageError, Message, Topic

_MOST_CONNECTIONS = 10_000

_MAGIC = b"#ROSBAG V2.0\n"
_MESSAGE, _BAG, _CHUNK, _CONNECTION = b"\x02", b"\x03", b"\x05", b"\x07"  # kinds of record
_LENGTH = struct.Struct("<I")
_TIME = struct.Struct("<II")


class _EndError(Exception):
    """The bytes end within a record."""


class Ros1Source:
    """A ROS 1 bag of version 2.0.

    Parameters
    ----------
    path : Path

    Raises
    ------
    DamageError
        The file is not such a bag, or is damaged.
    """

    def __init__(self, path: Path) -> None:
        self._path = path
        self._size = path.stat().st_size
        self._room = Room(path, self._size)
        self.incomplete = ""
        self._connections: dict[int, Topic] = {}
        counts: dict[int, int] = {}
        for connection, _, _ in self._all():
            counts[connection] = counts.get(connection, 0) + 1
        found: dict[tuple[str, str], Topic] = {}
        for connection, topic in self._connections.items():
            key = topic.name, topic.kind
            before = found[key].count or 0 if key in found else 0
            found[key] = Topic(
                name=topic.name,
                kind=topic.kind,
                encoding="ros1",
                definition=topic.definition,
                definition_format="ros1msg",
                count=before + counts.get(connection, 0),
            )
        self.topics = tuple(found.values())

    def messages(self, topic: Topic) -> Iterator[Message]:
        """Yield the messages of a topic."""
        wanted = {
            number
            for number, each in self._connections.items()
            if (each.name, each.kind) == (topic.name, topic.kind)
        }
        for connection, time, message in self._all():
            if connection in wanted:
                yield time, message

    def _all(self) -> Iterator[tuple[int, int, bytes]]:
        """Yield connection, log time and bytes of all messages, up to the file's end."""
        self._room.again()
        with self._path.open("rb") as stream:
            if stream.read(len(_MAGIC)) != _MAGIC:
                raise DamageError("it is not a ROS 1 bag of version 2.0")
            while stream.tell() < self._size:
                try:
                    header, body = _record(stream, self._size)
                except _EndError:
                    self.incomplete = "the file ends early: its last record is cut off, as if the recorder was killed"
                    return
                if header.get(b"op") == _BAG and header.get(b"index_pos", b"") == bytes(8):
                    self.incomplete = "the file has no index, as if the recorder was killed"
                if header.get(b"op") == _CHUNK:
                    yield from self._parts(_content(header, body, self._room))
                elif header.get(b"op") == _CONNECTION:
                    self._learn(header, body)

    def _parts(self, content: bytes) -> Iterator[tuple[int, int, bytes]]:
        place = 0
        while place < len(content):
            header_start, header_end = _span(content, place)
            start, place = _span(content, header_end)
            # Most records are messages with few fields: only these fields are read.
            header = _fields(content[header_start:header_end])
            kind = header.get(b"op")
            if kind == _MESSAGE:
                try:
                    (connection,) = _LENGTH.unpack(header[b"conn"])
                    seconds, rest = _TIME.unpack(header[b"time"])
                except (KeyError, struct.error):
                    raise DamageError("the header of a message is damaged") from None
                yield connection, seconds * 1_000_000_000 + rest, content[start:place]
            elif kind == _CONNECTION:
                self._learn(header, content[start:place])

    def _learn(self, header: dict[bytes, bytes], body: bytes) -> None:
        described = _fields(body)
        try:
            (number,) = _LENGTH.unpack(header[b"conn"])
            self._connections[number] = Topic(
                name=header[b"topic"].decode(),
                kind=normal_kind(described[b"type"].decode()),
                encoding="ros1",
                definition=described.get(b"message_definition", b"").decode("utf-8", "replace"),
                definition_format="ros1msg",
            )
        except (KeyError, UnicodeDecodeError, struct.error):
            raise DamageError("the description of a topic is damaged") from None
        if len(self._connections) > _MOST_CONNECTIONS:
            raise DamageError(f"it has more than {_MOST_CONNECTIONS} connections")


def _record(stream: BinaryIO, size: int) -> tuple[dict[bytes, bytes], bytes]:
    header = _fields(_part(stream, size))
    return header, _part(stream, size)


def _part(stream: BinaryIO, size: int) -> bytes:
    prefix = stream.read(_LENGTH.size)
    if len(prefix) < _LENGTH.size:
        raise _EndError
    (length,) = _LENGTH.unpack(prefix)
    if length > size - stream.tell():
        raise _EndError
    return stream.read(length)


def _span(content: bytes, place: int) -> tuple[int, int]:
    """Return begin and end of the part with its length at this place."""
    try:
        (length,) = _LENGTH.unpack_from(content, place)
    except struct.error:
        raise DamageError("a record of a chunk ends early") from None
    start = place + _LENGTH.size
    if start + length > len(content):
        raise DamageError("a record is longer than its chunk")
    return start, start + length


def _fields(header: bytes) -> dict[bytes, bytes]:
    found: dict[bytes, bytes] = {}
    place = 0
    while place < len(header):
        start, place = _span(header, place)
        name, equals, value = header[start:place].partition(b"=")
        if not equals:
            raise DamageError("the header of a record is damaged")
        found[name] = value
    return found


def _content(header: dict[bytes, bytes], body: bytes, room: Room) -> bytes:
    compression = header.get(b"compression", b"none")
    try:
        if compression == b"none":
            return body
        if compression == b"bz2":
            return room.bz2(body)
        if compression == b"lz4":
            return of_lz4(body, room)
    except (ModuleNotFoundError, InputError):
        raise
    # Damaged bytes: neither library documents its errors.
    except Exception as error:
        raise DamageError(f"a chunk is damaged ({reason_of(error)})") from None
    raise DamageError(f"the compression {compression.decode('ascii', 'replace')!r} is not read")
