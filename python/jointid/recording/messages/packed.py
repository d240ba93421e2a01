"""What robots' logs pack with Zstandard and LZ4, as far as the file has room for it."""

from jointid.base.unpacking import Room

_PART = 1 << 20  # bytes
_WINDOW = 1 << 27  # bytes that Zstandard looks back at most


def of_zstandard(content: bytes, room: Room) -> bytes:
    """Return what Zstandard has packed.

    Raises
    ------
    InputError
        The file holds more than it may.
    zstandard.ZstdError
        It is damaged.
    """
    import zstandard

    parts = []
    # Not in one call: that allocates whatever size the frame states.
    with zstandard.ZstdDecompressor(max_window_size=_WINDOW).stream_reader(content) as stream:
        while part := stream.read(_PART):
            room.take(len(part))
            parts.append(part)
    return b"".join(parts)


def of_lz4(content: bytes, room: Room) -> bytes:
    """Return what LZ4 has packed.

    Raises
    ------
    InputError
        The file holds more than it may.
    RuntimeError
        It is damaged, or cut off.
    """
    import lz4.frame

    unpacker = lz4.frame.LZ4FrameDecompressor()
    found = unpacker.decompress(content, max_length=room.left + 1)
    room.take(len(found))
    if not unpacker.eof:
        raise RuntimeError("it is cut off")
    return bytes(found)
