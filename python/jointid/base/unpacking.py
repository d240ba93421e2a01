"""How much a compressed file may hold: a limit for each file, so that a small one cannot fill the memory."""

from __future__ import annotations

import re
import zlib
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from pathlib import Path

from jointid.base.advice import Action
from jointid.base.errors import InputError

LEAST = 64_000_000  # bytes that any file may hold
TIMES = 50  # its size: recorded numbers are packed 2 to 20 times, and repeated ones 1000 times
_FIRST, _CHUNK = 256, 1 << 20  # bytes
_PADDED = re.compile(rb"\0*")  # a file may be


class TooLargeError(InputError):
    """A file holds more than it may: nobody reads it a second time."""


_raised: ContextVar[int] = ContextVar("unpacked", default=0)


@contextmanager
def allowing(unpacked: int | None) -> Iterator[None]:
    """Raise the limit of the files that are opened inside.

    Parameters
    ----------
    unpacked : int or None
        Bytes. None: the limit stays.

    Raises
    ------
    InputError
        It is no whole number above 0.
    """
    if unpacked is None:
        yield
        return
    if isinstance(unpacked, bool) or not isinstance(unpacked, int) or unpacked <= 0:
        raise InputError("a number of bytes is expected", argument="unpacked", value=unpacked)
    before = _raised.set(unpacked)
    try:
        yield
    finally:
        _raised.reset(before)


class Room:
    """What a file may still hold when it is unpacked.

    Parameters
    ----------
    path : Path
    size : int, optional
        Bytes of the file. Default: as it is on the disk.
    least : int, optional
        Bytes that it may hold, whatever its size. Default: 64 MB.

    Attributes
    ----------
    left : int
        Bytes.
    """

    def __init__(self, path: Path, size: int | None = None, least: int | None = None) -> None:
        self._path = path
        self._allowed = max(
            LEAST if least is None else least,
            TIMES * (path.stat().st_size if size is None else size),
            _raised.get(),
        )
        self.left = self._allowed

    def again(self) -> None:
        """Begin anew: the file is read once more."""
        self.left = self._allowed

    def take(self, size: int) -> None:
        """Count bytes that are unpacked, before they are.

        Raises
        ------
        InputError
            The file holds more than it may.
        """
        self.left -= size
        if self.left < 0:
            raise TooLargeError(
                f"the unpacked file is larger than {self._allowed / 1e6:.0f} MB, the limit for a file of its size",
                place=str(self._path),
                remedy=Action(
                    "call",
                    {"unpacked": ...},
                    text="the bytes that it may hold, if you trust the file",
                    function="load",
                ),
            )

    def gunzip(self, content: bytes) -> bytes:
        """Return what gzip has packed, also in several members.

        Raises
        ------
        InputError
            The file holds more than it may.
        EOFError
            It is cut off.
        zlib.error
            It is damaged.
        """
        parts = []
        place = 0
        while place < len(content):
            member = zlib.decompressobj(16 + zlib.MAX_WBITS)
            length = (
                _FIRST  # zlib copies what is behind a member: of a million members, all each time
            )
            while not member.eof:
                piece = content[place : place + length]
                if not piece:
                    raise EOFError
                found = member.decompress(piece, self.left + 1)
                self.take(len(found))
                parts.append(found)
                place += len(piece) - len(member.unused_data)
                length = min(2 * length, _CHUNK)
            place = _PADDED.match(content, place).end()  # type: ignore[union-attr]
        return b"".join(parts)

    def bz2(self, content: bytes) -> bytes:
        """Return what bzip2 has packed.

        Raises
        ------
        InputError
            The file holds more than it may.
        OSError, EOFError
            It is damaged, or cut off.
        """
        import bz2

        unpacker = bz2.BZ2Decompressor()
        found = unpacker.decompress(content, self.left + 1)
        self.take(len(found))
        if not unpacker.eof:
            raise EOFError("it ends early")
        return found
