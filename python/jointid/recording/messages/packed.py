"""Unpacking of Zstandard and LZ4 in robots' logs, within the memory limit of the file."""

from jointid.base.unpacking import Room

_PART = 1 << 20  # bytes
_WINDOW = 1 << 27  # largest window of Zstandard, in bytes


def of_zstandard(content: bytes, room: Room) -> bytes:
    """Return the content of Zstandard data.

    Raises
    ------
    InputError
        The content exceeds the memory limit.
            zstandard.ZstdError
                The data are damaged.
    """
    import zstandard

    parts = []
    # Not in one call: that would allocate whatever size the frame states.
    with zstandard.ZstdDecompressor(max_window_size=_WINDOW).stream_reader(content) as stream:
        while part := stream.read(_PART):
            room.take(len(part))
            parts.append(part)
    return b"".join(parts)


def of_lz4(content: bytes, room: Room) -> bytes:
    """Return the content of LZ4 data.

    Raises
    ------
    InputError
        The content exceeds the memory limit.
            RuntimeError
                The data are damaged or truncated.
    """
    import lz4.frame

    unpacker = lz4.frame.LZ4FrameDecompressor()
    found = unpacker.decompress(content, max_length=room.left + 1)
    room.take(len(found))
    if not unpacker.eof:
        raise RuntimeError("it is cut off")
    return bytes(found)
