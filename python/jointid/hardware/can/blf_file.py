"""Frame logs in BLF. Their compressed parts are unpacked here, because python-can sets no limit for the size."""

from __future__ import annotations

import struct
import zlib
from io import BytesIO
from pathlib import Path

from jointid.base.errors import InputError
from jointid.base.unpacking import Room

_FILE = struct.Struct("<4sL")  # signature, size of the header
_FILE_HEAD = 72  # bytes, without padding
_OBJECT = struct.Struct("<4sHHLL")  # signature, size and version of the header, size, kind
_CONTAINER = struct.Struct("<H6xL4x")  # method, unpacked size
_HEAD = _OBJECT.size + _CONTAINER.size
_CONTAINER_KIND = 10
_STORED, _ZLIB = 0, 2  # methods
_LARGEST = 1 << 20  # bytes of an object; a frame has a few hundred
_MOST = (1 << 32) - 1 - _HEAD  # bytes that a container may state


def unpacked(path: Path) -> BytesIO:
    """Return a BLF file with unpacked parts. Damaged data and everything after it stay unchanged.

    Parameters
    ----------
    path : Path

    Raises
    ------
    TooLargeError
        The unpacked data are too large.
    InputError
        An object claims to be smaller than its header, which python-can would read again and again, or it is
        very large. Or the compression method of a part is unknown; python-can would omit this part.
    OSError
        The file cannot be read.
    """
    content = path.read_bytes()
    room = Room(path, len(content))
    if len(content) < _FILE_HEAD or content[:4] != b"LOGG":
        return BytesIO(content)
    place = _FILE.unpack_from(content)[1]
    parts = [content[:place]]
    if place < _FILE_HEAD:  # a negative length makes python-can read all the rest
        return BytesIO(*parts)
    unfinished: bytes | None = b""  # an object may continue in the next container
    while unfinished is not None and place + _OBJECT.size <= len(content):
        signature, _, _, size, kind = _OBJECT.unpack_from(content, place)
        if signature != b"LOBJ":
            break
        if size < _OBJECT.size:  # see above
            return BytesIO(b"".join([*parts, signature]))
        beyond = place + size + size % 4
        part = content[place:beyond]
        if kind == _CONTAINER_KIND:
            if min(size, len(part)) < _HEAD:
                break
            try:
                plain = _plain(part[:size], room)
            except zlib.error:
                break
            unfinished = _behind_objects(unfinished + plain)
            part = _container(part, plain)
        parts.append(part)
        place = beyond
    return BytesIO(b"".join([*parts, content[place:]]))


def _plain(part: bytes, room: Room) -> bytes:
    """Return the content of a container."""
    method, _ = _CONTAINER.unpack_from(part, _OBJECT.size)
    if method == _STORED:
        return part[_HEAD:]
    if method != _ZLIB:
        raise InputError(f"a part has the compression method {method}, which jointid cannot read")
    plain = zlib.decompressobj().decompress(part[_HEAD:], room.left + 1)
    room.take(len(plain))
    if len(plain) > _MOST:
        raise InputError(f"an unpacked part is larger than {_MOST} bytes")
    return plain


def _container(part: bytes, plain: bytes) -> bytes:
    """Return a container with the same content, not compressed."""
    signature, length, version, _, kind = _OBJECT.unpack_from(part)
    size = _HEAD + len(plain)
    head = _OBJECT.pack(signature, length, version, size, kind)
    return b"".join([head, _CONTAINER.pack(_STORED, len(plain)), plain, bytes(size % 4)])


def _behind_objects(content: bytes) -> bytes | None:
    """Return the data after the last whole object; None if no object follows, where python-can stops reading."""
    place = 0
    while (found := content.find(b"LOBJ", place, place + 8)) >= 0:
        if found + _OBJECT.size > len(content):
            break
        size = _OBJECT.unpack_from(content, found)[3]
        if size < _OBJECT.size:
            raise InputError(f"an object has {size} bytes, fewer than its header needs")
        if size > _LARGEST:  # it would be joined again for each container
            raise InputError(f"an object has {size} bytes, more than the limit of {_LARGEST}")
        if found + size > len(content):
            break
        place = found + size
    if found < 0 and place + 8 <= len(content):
        return None
    return content[place:]
