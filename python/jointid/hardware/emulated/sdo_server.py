"""The SDO server of an emulated CANopen device: expedited and segmented transfers, aborts."""

from __future__ import annotations

import struct
from dataclasses import dataclass

from jointid.hardware.emulated.object_dictionary import (
    TOO_LONG,
    TOO_SHORT,
    AccessError,
    ObjectDictionary,
)

_TOGGLE_WRONG, _COMMAND_WRONG, _NO_MEMORY = 0x05030000, 0x05040001, 0x05040005
_LARGEST = 4096  # bytes of a segmented download
_SEGMENT = 7


@dataclass(slots=True, kw_only=True)
class _Transfer:
    """A segmented transfer in progress."""

    index: int
    subindex: int
    upload: bool
    content: bytes
    announced: int | None = None  # bytes
    toggle: int = 0


class SdoServer:
    """Answer a client's requests, one transfer at a time.

    Parameters
    ----------
    objects : ObjectDictionary
    """

    def __init__(self, objects: ObjectDictionary) -> None:
        self._objects = objects
        self._transfer: _Transfer | None = None

    def forget(self) -> None:
        """Drop a transfer in progress, as a reset does."""
        self._transfer = None

    def answer(self, payload: bytes) -> bytes | None:
        """Return the answer to a frame; None if the client has aborted.

        Parameters
        ----------
        payload : bytes
            Payload of a frame to the server. Any length other than eight bytes is aborted.
        """
        if payload[:1] == b"\x80":
            self._transfer = None
            return None
        place = (payload[1:4] + bytes(3))[:3]
        going_on = self._transfer
        if payload and payload[0] >> 5 in (0, 3) and going_on is not None:
            place = struct.pack("<HB", going_on.index, going_on.subindex)
        try:
            if len(payload) != 8:
                raise AccessError(_COMMAND_WRONG)
            return self._answer(payload)
        except AccessError as error:
            self._transfer = None
            return b"\x80" + place + struct.pack("<I", error.code)

    def _answer(self, payload: bytes) -> bytes:
        command = payload[0] >> 5
        if command == 0:
            return self._download_segment(payload)
        if command == 3:
            return self._upload_segment(payload[0] >> 4 & 1)
        self._transfer = None  # a new request ends a transfer in progress
        index, subindex = struct.unpack_from("<HB", payload, 1)
        if command == 1:
            return self._download(payload, index, subindex)
        if command == 2:
            return self._upload(payload, index, subindex)
        raise AccessError(_COMMAND_WRONG)  # block transfers are not supported

    def _download(self, payload: bytes, index: int, subindex: int) -> bytes:
        expedited, sized = payload[0] & 0x2, payload[0] & 0x1
        done = b"\x60" + payload[1:4] + bytes(4)
        if expedited:
            length = 4 - (payload[0] >> 2 & 0x3)
            if not sized:
                length = min(4, self._objects.entry(index, subindex).size or 4)
            self._objects.write(index, subindex, payload[4 : 4 + length])
            return done
        entry = self._objects.entry(index, subindex)
        announced = int.from_bytes(payload[4:8], "little") if sized else None
        if announced is not None and entry.size and announced != entry.size:
            raise AccessError(TOO_LONG if announced > entry.size else TOO_SHORT)
        self._transfer = _Transfer(
            index=index, subindex=subindex, upload=False, content=b"", announced=announced
        )
        return done

    def _download_segment(self, payload: bytes) -> bytes:
        transfer, toggle = self._going_on(upload=False), payload[0] >> 4 & 1
        self._check_toggle(transfer, toggle)
        transfer.content += payload[1 : 8 - (payload[0] >> 1 & 0x7)]
        if len(transfer.content) > _LARGEST:
            raise AccessError(_NO_MEMORY)
        if payload[0] & 0x1:  # last segment
            self._transfer = None
            length = len(transfer.content)
            if transfer.announced is not None and length != transfer.announced:
                raise AccessError(TOO_LONG if length > transfer.announced else TOO_SHORT)
            self._objects.write(transfer.index, transfer.subindex, transfer.content)
        return bytes((0x20 | toggle << 4,)) + bytes(7)

    def _upload(self, payload: bytes, index: int, subindex: int) -> bytes:
        content = self._objects.read(index, subindex)
        if 1 <= len(content) <= 4:
            head = 0x43 | 4 - len(content) << 2
            return bytes((head,)) + payload[1:4] + content.ljust(4, b"\0")
        self._transfer = _Transfer(index=index, subindex=subindex, upload=True, content=content)
        return b"\x41" + payload[1:4] + struct.pack("<I", len(content))

    def _upload_segment(self, toggle: int) -> bytes:
        transfer = self._going_on(upload=True)
        self._check_toggle(transfer, toggle)
        segment, transfer.content = transfer.content[:_SEGMENT], transfer.content[_SEGMENT:]
        last = not transfer.content
        if last:
            self._transfer = None
        head = toggle << 4 | _SEGMENT - len(segment) << 1 | last
        return bytes((head,)) + segment.ljust(_SEGMENT, b"\0")

    def _going_on(self, *, upload: bool) -> _Transfer:
        if self._transfer is None or self._transfer.upload is not upload:
            raise AccessError(_COMMAND_WRONG)
        return self._transfer

    def _check_toggle(self, transfer: _Transfer, toggle: int) -> None:
        if toggle != transfer.toggle:
            raise AccessError(_TOGGLE_WRONG)
        transfer.toggle ^= 1
