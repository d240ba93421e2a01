"""SDO read of any length, e.g. of a text: expedited, or in segments of seven bytes (CiA 301)."""

from __future__ import annotations

import struct
from collections.abc import Callable

from jointid.base.errors import InputError
from jointid.hardware.can.canopen_frames import SdoAbortError

_MOST_SEGMENTS = 256  # a text of 1.8 kB; reading stops if a server never ends
_LAST, _TOGGLE, _ABORTED = 0x01, 0x10, 0x80


def upload(exchange: Callable[[bytes], bytes], index: int, subindex: int) -> bytes:
    """Return the bytes of an object.

    Parameters
    ----------
    exchange : callable
        Sends the eight bytes of a request and returns those of the answer.
    index, subindex : int

    Raises
    ------
    SdoAbortError
        The drive refused the request.
    InputError
        An answer does not belong to the request.
    """
    answer = _answer(exchange, b"\x40" + struct.pack("<HB", index, subindex) + bytes(4), index)
    command = answer[0]
    if struct.unpack_from("<HB", answer, 1) != (index, subindex) or command & 0xE0 != 0x40:
        raise InputError(f"object {index:04X}h:{subindex} is answered by {answer.hex(' ')}")
    if command & 0x02:
        size = 4 - (command >> 2 & 0x3) if command & 0x01 else 4
        return answer[4 : 4 + size]
    found, toggle = b"", 0
    for _ in range(_MOST_SEGMENTS):
        answer = _answer(exchange, bytes((0x60 | toggle, *bytes(7))), index)
        if answer[0] & 0xE0 or answer[0] & _TOGGLE != toggle:
            raise InputError(
                f"a segment of object {index:04X}h begins with an invalid byte, {answer[0]:02X}"
            )
        found += answer[1 : 8 - (answer[0] >> 1 & 0x7)]
        if answer[0] & _LAST:
            return found
        toggle ^= _TOGGLE
    raise InputError(f"the last segment of object {index:04X}h is missing")


def _answer(exchange: Callable[[bytes], bytes], request: bytes, index: int) -> bytes:
    answer = exchange(request)
    if len(answer) != 8:
        raise InputError(f"an SDO answer has {len(answer)} bytes; 8 are expected")
    if answer[0] == _ABORTED:
        place, subindex, code = struct.unpack("<HBI", answer[1:])
        raise SdoAbortError(place or index, subindex, code)
    return answer
