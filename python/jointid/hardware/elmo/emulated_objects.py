"""The object dictionary of an emulated drive: what a session reads and sets, and which PDO it gets."""

from __future__ import annotations

from jointid.base.errors import InputError
from jointid.hardware.can.canopen_frames import SdoRequest, sdo_abort, sdo_answer

_MAPPABLE = {0x60640020: "position", 0x60690020: "velocity", 0x606C0020: "velocity"}
_MAPPABLE |= {0x60770010: "torque"}
_IDENTITY = {0x1018_01: 0x9A, 0x1018_02: 0x00030924, 0x1018_03: 0x01010301}
_OFF = 0xC0000000  # of a PDO's COB-ID: it is not sent


class ObjectDictionary:
    """Objects by index and subindex, and what they stand for.

    Parameters
    ----------
    node : int
    """

    def __init__(self, node: int) -> None:
        self._node = node
        self.reset()

    def reset(self) -> None:
        """As after power-up; also a reset of the communication does that."""
        self._values = dict(_IDENTITY)
        self.mapping: list[str] = []
        self.sync_every = 0
        self._position_cob = _OFF | (0x480 + self._node)

    def get(self, index: int, subindex: int, default: int = 0) -> int:
        """The value of an object."""
        return self._values.get(index << 8 | subindex, default)

    @property
    def position_id(self) -> int | None:
        """COB-ID of the PDO with the position; None while it is not sent."""
        off = self._position_cob >> 31 or not self.sync_every
        return None if off else self._position_cob & 0x7FF

    @property
    def master(self) -> int:
        """The node whose heartbeat is watched."""
        return self.get(0x1016, 1) >> 16 & 0x7F

    @property
    def consumer_time(self) -> float:
        """Time for which that heartbeat may be missing [s]; 0: without limit."""
        return (self.get(0x1016, 1) & 0xFFFF) * 1e-3

    @property
    def producer_time(self) -> float:
        """Between two heartbeats of the drive's own [s]; 0: it sends none."""
        return (self.get(0x1017, 0) & 0xFFFF) * 1e-3

    def answer(self, payload: bytes) -> bytes | None:
        """The answer to a request's bytes; None when they are none."""
        try:
            request = SdoRequest.of(payload)
        except InputError:
            return None
        key = request.index << 8 | request.subindex
        if request.value is not None:
            return self._assign(request, key, request.value)
        if key in self._values:
            return sdo_answer(request, self._values[key])
        return sdo_abort(request, 0x06020000)

    def _assign(self, request: SdoRequest, key: int, value: int) -> bytes:
        if key == 0x1803_01:
            self._position_cob = value
        elif key == 0x1803_02:
            self.sync_every = value if 1 <= value <= 240 else 0
        elif key == 0x1A03_00:
            if value and not self._position_cob >> 31:
                return sdo_abort(request, 0x08000022)
            self.mapping = self.mapping[:value]
        elif request.index == 0x1A03:
            if value not in _MAPPABLE:
                return sdo_abort(request, 0x06040041)
            self.mapping = [*self.mapping[: request.subindex - 1], _MAPPABLE[value]]
        elif request.index in (0x1803, 0x1018):
            return sdo_abort(request, 0x06010000)
        self._values[key] = value
        return sdo_answer(request)
