"""Places of the numbers in a serialised message (CDR of ROS 2, serialisation of ROS 1).

Nearly all messages of a topic have the same layout: their sequences and strings have the same lengths, so that each
number is at the same place. One message is decoded field by field. All messages with the same lengths and names,
byte for byte, are then decoded together.
"""

import struct
from dataclasses import field
from typing import Any

import numpy as np
import numpy.typing as npt

from jointid.base.values import dataclass
from jointid.recording.messages.definitions import Types
from jointid.recording.messages.joints import Path, may_name
from jointid.recording.messages.topic import DamageError

Bytes = npt.NDArray[np.uint8]

_CODES = {
    "bool": "u1",
    "byte": "u1",
    "char": "u1",
    "int8": "i1",
    "uint8": "u1",
    "int16": "i2",
    "uint16": "u2",
    "int32": "i4",
    "uint32": "u4",
    "int64": "i8",
    "uint64": "u8",
    "float32": "f4",
    "float64": "f8",
}
_BASE, _NAME, _ARRAY, _SEQUENCE = 1, 2, 3, 4  # kinds of a field's description in rosbags
_LONGEST = 1024  # numbers of a sequence; a longer sequence is an image or a scan
_DEEPEST = 32
_MOST = 8192  # numbers in a message, and also texts
_SPARE = 10_000  # elements of a message in addition to one per byte: some elements take no bytes


@dataclass
class Layout:
    """The places of the numbers and names in messages with the same layout.

    Attributes
    ----------
    numbers : list of (path, offset, dtype, count)
        Each number (count 0), or sequence of numbers; the paths of its elements are this path with their index.
    names : dict of path to str
        The texts that may name joints.
    fixed : list of (start, stop)
        Bytes that determine the layout: lengths and texts.
    """

    numbers: list[tuple[Path, int, str, int]] = field(default_factory=list)
    names: dict[Path, str] = field(default_factory=dict)
    fixed: list[tuple[int, int]] = field(default_factory=list)


def layout_of(message: bytes, kind: str, types: Types, encoding: str) -> Layout:
    """Return the layout of a message.

    Parameters
    ----------
    message : bytes
    kind : str
        Type of the message.
    types : mapping
        Types from `types_of`.
    encoding : {"cdr", "ros1"}

    Raises
    ------
    DamageError
        The bytes are not a message of this type.
    """
    walk = _Walk(message, types, encoding)
    try:
        walk.fields(kind, (), 0)
    except (struct.error, UnicodeDecodeError):
        raise DamageError("it does not fit its message type") from None
    spare = len(message) - walk.position
    if spare < 0 or spare > (3 if encoding == "cdr" else 0):
        raise DamageError("its length does not fit its message type")
    return walk.layout


def fixed_places(layout: Layout) -> npt.NDArray[np.intp]:
    """Return the indices of the bytes that determine a layout."""
    parts = [np.arange(start, stop, dtype=np.intp) for start, stop in layout.fixed]
    return np.concatenate(parts) if parts else np.empty(0, dtype=np.intp)


def read_numbers(block: Bytes, offset: int, code: str, count: int) -> npt.NDArray[Any]:
    """Return the numbers at one place of many messages, shape (messages, count or 1).

    Parameters
    ----------
    block : ndarray of uint8, shape (messages, bytes of each)
    offset, code, count
        Same as in `Layout.numbers`.
    """
    width = int(code[-1]) * max(count, 1)
    return np.ascontiguousarray(block[:, offset : offset + width]).view(code)


class _Walk:
    """One pass over the bytes of a message."""

    def __init__(self, message: bytes, types: Types, encoding: str) -> None:
        self.layout = Layout()
        self._message, self._types = message, types
        self._aligned = encoding == "cdr"
        self._order = "<"
        self.position = self._origin = 0
        self._left = len(message) + _SPARE
        self._numbers_left = self._texts_left = _MOST
        if self._aligned:
            if len(message) < 4 or message[0] != 0 or message[1] > 1:
                raise DamageError("its encapsulation is not plain CDR")
            self._order = "<" if message[1] else ">"
            self.layout.fixed.append((0, 2))
            self.position = self._origin = 4

    def fields(self, kind: str, path: Path, depth: int) -> None:
        """Walk the fields of a message inside the message."""
        if depth > _DEEPEST:
            raise DamageError("its type contains itself")
        fields = self._types.get(kind)
        if fields is None:
            raise DamageError(f"the file does not define its message type {kind}")
        for name, description in fields:
            self._field(description, (*path, name), depth)

    def _field(self, description: Any, path: Path, depth: int) -> None:
        node, rest = int(description[0]), description[1]
        if node in (_BASE, _NAME):
            self._one(node, rest, path, depth)
            return
        (inner, kind), count = rest
        if node == _SEQUENCE:
            count = self._length()
        if inner == _BASE and kind[0] in _CODES:
            self._numbers(path, _CODES[kind[0]], count, each=True)
            return
        if count > len(self._message):
            raise DamageError("a sequence is longer than the message")
        for index in range(count):
            self._one(int(inner), kind, (*path, index), depth)

    def _one(self, node: int, kind: Any, path: Path, depth: int) -> None:
        self._left -= 1
        if self._left < 0:
            raise DamageError("it states more elements than it has bytes")
        if node == _NAME:
            self.fields(kind, path, depth + 1)
        elif kind[0] == "string":
            self._text(path)
        elif kind[0] in _CODES:
            self._numbers(path, _CODES[kind[0]], 1, each=False)
        else:
            raise DamageError(f"values of type {kind[0]} are not read")

    def _numbers(self, path: Path, code: str, count: int, *, each: bool) -> None:
        """Note a number, or a sequence of numbers with a column each."""
        if not count:  # an empty sequence has no alignment
            return
        size = int(code[-1])
        if self._aligned:
            self.position += -(self.position - self._origin) % size
        start = self.position
        self.position += count * size
        if self.position > len(self._message):
            raise DamageError("it ends early")
        if count <= _LONGEST:
            self._numbers_left -= count
            if self._numbers_left < 0:
                raise DamageError(f"it holds more than {_MOST} numbers")
            self.layout.numbers.append((path, start, self._order + code, count if each else 0))

    def _length(self) -> int:
        if self._aligned:
            self.position += -(self.position - self._origin) % 4
        start = self.position
        (length,) = struct.unpack_from(self._order + "I", self._message, start)
        self.position += 4
        self.layout.fixed.append((start, start + 4))
        return int(length)

    def _text(self, path: Path) -> None:
        length, start = self._length(), self.position
        self.position += length
        if self.position > len(self._message):
            raise DamageError("it ends early")
        text = self._message[start : self.position]
        if may_name(path):
            self._texts_left -= 1
            if self._texts_left < 0:
                raise DamageError(f"it holds more than {_MOST} texts")
            self.layout.names[path] = text.rstrip(b"\0").decode("utf-8")
            self.layout.fixed.append((start, self.position))
