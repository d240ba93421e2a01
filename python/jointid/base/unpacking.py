"""Size limit of each compressed file's content, so that a small file cannot fill the memory."""

from __future__ import annotations

import re
import zlib
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from pathlib import Path

from jointid.base.advice import Action
from jointid.base.errors import InputError

LEAST = 64_000_000  # bytes: limit for any small file
TIMES = 50  # times the file's size: recorded numbers compress 2 to 20 times
_FIRST, _CHUNK = 256, 1 << 20  # bytes
_PADDED = re.compile(rb"\0*")  # padding after a gzip member


class TooLargeError(InputError):
    """A file exceeds its size limit; it is not read in another form."""


_raised: ContextVar[int] = ContextVar("unpacked", default=0)


@contextmanager
def allowing(unpacked: int | None) -> Iterator[None]:
    """Raise the limit for files that are opened in the block.

    Parameters
    ----------
    unpacked : int or None
        Limit in bytes. None: the default limit.

    Raises
    ------
    InputError
        The limit is not a whole number above 0.
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
    """Remaining size limit of a file's unpacked content.

    Parameters
    ----------
    path : Path
    size : int, optional
        Size of the file in bytes. Default: size on disk.
    least : int, optional
        Limit in bytes for small files. Default: 64 MB.

    Attributes
    ----------
    left : int
        Remaining bytes.
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
        """Start again, because the file is read once more."""
        self.left = self._allowed

    def take(self, size: int) -> None:
        """Count bytes before they are unpacked.

        Raises
        ------
        InputError
            The file exceeds its limit.
        """
        self.left -= size
        if self.left < 0:
            raise TooLargeError(
                f"the unpacked file is larger than {self._allowed / 1e6:.0f} MB, the limit for this packed size",
                place=str(self._path),
                remedy=Action(
                    "call",
                    {"unpacked": ...},
                    text="the largest unpacked size in bytes, if you trust the file",
                    function="load",
                ),
            )

    def gunzip(self, content: bytes) -> bytes:
        """Return the content of gzip data, also with several members.

        Raises
        ------
        InputError
            The file exceeds its limit.
        EOFError
            The data are truncated.
        zlib.error
            The data are damaged.
        """
        parts = []
        place = 0
        while place < len(content):
            member = zlib.decompressobj(16 + zlib.MAX_WBITS)
            length = _FIRST  # zlib copies all bytes behind each member: slow for a million
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
        """Return the content of bzip2 data.

        Raises
        ------
        InputError
            The file exceeds its limit.
        OSError, EOFError
            The data are damaged or truncated.
        """
        import bz2

        unpacker = bz2.BZ2Decompressor()
        found = unpacker.decompress(content, self.left + 1)
        self.take(len(found))
        if not unpacker.eof:
            raise EOFError("it ends early")
        return found
