"""CANopen frames that a session needs (CiA 301): network, SYNC, heartbeat, expedited SDO."""

from __future__ import annotations

import struct
from dataclasses import dataclass

from jointid.base.errors import InputError

NMT, SYNC = 0x000, 0x080
START, STOP, PRE_OPERATIONAL, RESET_NODE, RESET_COMMUNICATION = 0x01, 0x02, 0x80, 0x81, 0x82
STATES = {0x00: "boot-up", 0x04: "stopped", 0x05: "operational", 0x7F: "pre-operational"}

_ABORTS = {
    0x06010000: "access not supported",
    0x06020000: "the object does not exist",
    0x06040041: "the object cannot be mapped",
    0x06070010: "the data has another length",
    0x06090011: "the sub-index does not exist",
    0x06090030: "the value is out of range",
    0x08000022: "the request is not possible in this state of the device",
}


class SdoAbortError(RuntimeError):
    """The drive refused an object.

    Parameters
    ----------
    index, subindex, code : int
    """

    def __init__(self, index: int, subindex: int, code: int) -> None:
        meaning = _ABORTS.get(code, "not listed")
        super().__init__(
            f"the drive refused object {index:04X}h:{subindex}: {meaning} (abort {code:08X}h)"
        )
        self.index, self.subindex, self.code = index, subindex, code


def heartbeat_id(node: int) -> int:
    """Return the COB-ID of a node's boot-up message and heartbeat."""
    return 0x700 + node


def emergency_id(node: int) -> int:
    """Return the COB-ID of a node's emergency messages."""
    return 0x080 + node


def network(command: int, node: int) -> bytes:
    """Return the bytes of a network command."""
    return bytes((command, node))


@dataclass(frozen=True, slots=True, kw_only=True)
class SdoRequest:
    """SDO request: a read, or a write of at most four bytes.

    Attributes
    ----------
    index, subindex : int
    value : int or None
        Value to write; None for a read.
    size : int
        Number of bytes of the value: 1, 2 or 4.
    """

    index: int
    subindex: int
    value: int | None = None
    size: int = 4

    def payload(self) -> bytes:
        """Return the eight bytes of the request."""
        place = struct.pack("<HB", self.index, self.subindex)
        if self.value is None:
            return b"\x40" + place + bytes(4)
        number = (self.value & (1 << 8 * self.size) - 1).to_bytes(4, "little")
        return bytes((0x23 | (4 - self.size) << 2,)) + place + number

    @classmethod
    def of(cls, payload: bytes) -> SdoRequest:
        """Return the request in a frame.

        Raises
        ------
        InputError
            The frame is not an expedited request.
        """
        if len(payload) != 8:
            raise InputError(f"an SDO request has {len(payload)} bytes; 8 are expected")
        index, subindex = struct.unpack_from("<HB", payload, 1)
        if payload[0] == 0x40:
            return cls(index=index, subindex=subindex)
        if payload[0] & 0xF3 == 0x23:
            size = 4 - (payload[0] >> 2 & 0x3)
            number = int.from_bytes(payload[4 : 4 + size], "little")
            return cls(index=index, subindex=subindex, value=number, size=size)
        raise InputError(
            f"an SDO request begins with {payload[0]:02X}; an expedited request is expected"
        )


def sdo_answer(request: SdoRequest, value: int | None = None) -> bytes:
    """Return a drive's answer to a request: a confirmed write, or the value of a read."""
    place = struct.pack("<HB", request.index, request.subindex)
    if value is None:
        return b"\x60" + place + bytes(4)
    return b"\x43" + place + struct.pack("<I", value & 0xFFFFFFFF)


def sdo_abort(request: SdoRequest, code: int) -> bytes:
    """Return a drive's answer that refuses a request."""
    return b"\x80" + struct.pack("<HBI", request.index, request.subindex, code)


def sdo_result(payload: bytes, request: SdoRequest) -> int | None:
    """Return the value in an answer, 0 after a write; None if it answers another request.

    Raises
    ------
    SdoAbortError
        The drive refused.
    """
    if len(payload) != 8:
        return None
    index, subindex = struct.unpack_from("<HB", payload, 1)
    if (index, subindex) != (request.index, request.subindex):
        return None
    if payload[0] == 0x80:
        raise SdoAbortError(index, subindex, int.from_bytes(payload[4:8], "little"))
    if payload[0] == 0x60:
        return 0
    if payload[0] & 0xF3 == 0x43:
        size = 4 - (payload[0] >> 2 & 0x3)
        return int.from_bytes(payload[4 : 4 + size], "little")
    return int.from_bytes(payload[4:8], "little") if payload[0] == 0x42 else None
