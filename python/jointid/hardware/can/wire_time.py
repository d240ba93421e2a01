"""Time of a frame on the bus, with the largest number of stuff bits and the gap after the frame."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import can

_GAP = 13  # bits after the last data: delimiters, acknowledgement, end of frame, gap
_FD_LENGTHS = (0, 1, 2, 3, 4, 5, 6, 7, 8, 12, 16, 20, 24, 32, 48, 64)  # bytes
_LONG = 16  # bytes; a longer CAN FD frame has a longer checksum


def bits_on_wire(length: int, *, extended: bool = False) -> int:
    """Return the bits of a classic frame with this number of bytes. An extended identifier has 29 bits."""
    plain = (54 if extended else 34) + 8 * length
    return plain + (plain - 1) // 4 + _GAP


def fd_bits_on_wire(length: int, *, extended: bool = False) -> tuple[int, int]:
    """Return the bits of a CAN FD frame: those at the bit rate of the bus, and those at the bit rate of the data."""
    carried = next((each for each in _FD_LENGTHS if each >= length), _FD_LENGTHS[-1])
    head = 36 if extended else 17
    body = 5 + 8 * carried
    stuffed_head = head + (head - 1) // 4
    stuffed = head + body + (head + body - 1) // 4
    count_and_checksum = 4 + (21 + 7 if carried > _LONG else 17 + 6)  # with their fixed stuff bits
    return stuffed_head + _GAP, stuffed - stuffed_head + count_and_checksum


def frame_time(message: can.Message, bitrate: float, data_bitrate: float | None = None) -> float:
    """Return the time of a frame on the bus [s].

    Parameters
    ----------
    message : can.Message
    bitrate : float
        Bit rate of the bus [bit/s].
    data_bitrate : float, optional
        Bit rate of the data of a CAN FD frame that switches the bit rate [bit/s]. Default: `bitrate`.
    """
    length = 0 if message.is_remote_frame else message.dlc
    if not message.is_fd:
        return bits_on_wire(length, extended=message.is_extended_id) / bitrate
    slow, fast = fd_bits_on_wire(length, extended=message.is_extended_id)
    switched = data_bitrate if message.bitrate_switch else None
    return slow / bitrate + fast / (bitrate if switched is None else switched)
