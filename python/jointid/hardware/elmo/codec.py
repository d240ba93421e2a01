"""Encode and decode the frames of Elmo's binary interpreter. Nothing here uses a bus.

Layout (Elmo's CANopen DS 301 implementation guide, MAN-CAN301IG): two letters, fourteen bits of index, one
bit for a query (to the drive) or an error (from the drive), one bit for a float, four bytes of value.
"""

from __future__ import annotations

import math
import re
import struct
from dataclasses import dataclass

from jointid.base.errors import InputError
from jointid.hardware.elmo.errors import error_meaning

_QUERY_OR_ERROR, _FLOAT = 0x40, 0x80
_LARGEST_INDEX = 0x3FFF
_LARGEST_FLOAT = float(struct.unpack("<f", b"\xff\xff\x7f\x7f")[0])
_LETTERS = re.compile(r"[A-Z]{2}")


class DriveError(RuntimeError):
    """The drive refused a command.

    Parameters
    ----------
    letters : str
    index : int
    code : int
        EC.
    """

    def __init__(self, letters: str, index: int, code: int) -> None:
        super().__init__(
            f"the drive refused {_named(letters, index)}: {error_meaning(code)} (EC {code})"
        )
        self.letters, self.index, self.code = letters, index, code


@dataclass(frozen=True, slots=True, kw_only=True)
class Command:
    """One command to the drive.

    Attributes
    ----------
    letters : str
        Two capital letters, e.g. "TC".
    index : int
        0 for a scalar; 1 in CL[1].
    value : int, float or None
        Assigned value. None: a query, or the execution of a command such as ST.
    """

    letters: str
    index: int = 0
    value: int | float | None = None

    def __post_init__(self) -> None:
        if not isinstance(self.letters, str) or not _LETTERS.fullmatch(self.letters):
            raise InputError(
                "two capital letters are expected", argument="letters", value=self.letters
            )
        if isinstance(self.index, bool) or not isinstance(self.index, int):
            raise InputError("a whole number is expected", argument="index", value=self.index)
        if not 0 <= self.index <= _LARGEST_INDEX:
            raise InputError(
                f"0 to {_LARGEST_INDEX} is expected", argument="index", value=self.index
            )
        if self.value is not None:
            _check_value(_named(self.letters, self.index), self.value)

    @property
    def key(self) -> tuple[str, int]:
        """Letters and index, which the reply repeats."""
        return self.letters, self.index

    def payload(self) -> bytes:
        """Return the bytes of the frame: four for a query or an execution, eight for an assignment.

        A query is always four bytes long: an eight-byte frame of zeros would assign 0, for example with PX
        the encoder position.
        """
        letters = self.letters.encode("ascii")
        low, high = self.index & 0xFF, self.index >> 8
        if self.value is None:
            return letters + bytes((low, high))
        if isinstance(self.value, float):
            return letters + bytes((low, high | _FLOAT)) + struct.pack("<f", self.value)
        return letters + bytes((low, high)) + struct.pack("<i", self.value)

    @classmethod
    def of(cls, payload: bytes) -> Command:
        """Decode the command in a frame, as the drive reads it.

        Raises
        ------
        InputError
            The bytes are not a command.
        """
        letters, index, flags = _head(payload)
        if len(payload) not in (4, 8):
            raise InputError(f"a command has {len(payload)} bytes; 4 or 8 are expected")
        if len(payload) == 4 or flags & _QUERY_OR_ERROR:
            return cls(letters=letters, index=index)
        return cls(letters=letters, index=index, value=_value(payload, flags))


@dataclass(frozen=True, slots=True, kw_only=True)
class Reply:
    """Answer of the drive.

    Attributes
    ----------
    letters : str
    index : int
    value : int or float
        The assigned value, or 0 for an execution.
    """

    letters: str
    index: int
    value: int | float

    @property
    def key(self) -> tuple[str, int]:
        """Letters and index of the command that the reply answers."""
        return self.letters, self.index

    def payload(self) -> bytes:
        """Return the eight bytes of the frame."""
        _check_value(_named(self.letters, self.index), self.value)
        return Command(letters=self.letters, index=self.index, value=self.value).payload()

    @classmethod
    def of(cls, payload: bytes) -> Reply:
        """Decode the reply in a frame.

        Raises
        ------
        DriveError
            The drive refused the command.
        InputError
            The bytes are not a reply.
        """
        letters, index, flags = _head(payload)
        if len(payload) != 8:
            raise InputError(f"a reply of {len(payload)} bytes; 8 are expected")
        if flags & _QUERY_OR_ERROR:
            raise DriveError(letters, index, int.from_bytes(payload[4:8], "little"))
        return cls(letters=letters, index=index, value=_value(payload, flags))


def refusal(letters: str, index: int, code: int) -> bytes:
    """Return the frame of a reply that refuses a command."""
    low, high = index & 0xFF, index >> 8
    return letters.encode("ascii") + bytes((low, high | _QUERY_OR_ERROR)) + struct.pack("<I", code)


def _named(letters: str, index: int) -> str:
    return f"{letters}[{index}]" if index else letters


def _head(payload: bytes) -> tuple[str, int, int]:
    if len(payload) < 4:
        raise InputError(f"an interpreter frame has {len(payload)} bytes; at least 4 are expected")
    letters = bytes(payload[:2]).decode("latin-1")
    if not _LETTERS.fullmatch(letters):
        raise InputError(
            f"an interpreter frame begins with {payload[:2].hex(' ')}; two capital letters are expected"
        )
    return letters, payload[2] | (payload[3] & 0x3F) << 8, payload[3]


def _value(payload: bytes, flags: int) -> int | float:
    if not flags & _FLOAT:
        return int(struct.unpack("<i", payload[4:8])[0])
    value = float(struct.unpack("<f", payload[4:8])[0])
    if not math.isfinite(value):
        raise InputError(
            "a finite value is expected", argument=payload[:2].decode("latin-1"), value=value
        )
    return value


def _check_value(named: str, value: object) -> None:
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise InputError("an int or a float is expected", argument=named, value=value)
    if isinstance(value, float):
        if not math.isfinite(value) or abs(value) > _LARGEST_FLOAT:
            raise InputError("a finite 32-bit float is expected", argument=named, value=value)
    elif not -(2**31) <= value < 2**31:
        raise InputError("a 32-bit integer is expected", argument=named, value=value)
