"""PDOs of an emulated CANopen device: parameters, mapping rules and transmission."""

from __future__ import annotations

from jointid.hardware.emulated.object_dictionary import (
    NOT_MAPPABLE,
    OUT_OF_RANGE,
    TOO_MUCH_MAPPED,
    WRONG_STATE,
    AccessError,
    Entry,
    ObjectDictionary,
)

OFF = 0x80000000  # bit of a COB-ID: the PDO is off
EVENT = (254, 255)  # transmission types: events of the manufacturer or of the profile
_EXTENDED = 0x20000000
_MOST = 8  # objects, and bytes, in a PDO
# Identifiers that CiA 301 reserves: network, SYNC's neighbours, SDO, heartbeat.
_RESERVED = (range(0x081), range(0x101, 0x181), range(0x580, 0x800))


class Pdo:
    """One PDO: communication and mapping parameters.

    Parameters
    ----------
    objects : ObjectDictionary
        Receives the parameters. `communication` and `mapping` are their indices.
    communication, mapping : int
    cob : int
        COB-ID after a reset, with the bit that switches it off.
    mapped : sequence of int
        Mapping after a reset: index, sub-index and bits in one number.
    types : container of int
        Transmission types that the device supports.
    kind : int
        Transmission type after a reset.
    sent : bool
        Whether the device sends it.
    """

    def __init__(
        self,
        objects: ObjectDictionary,
        communication: int,
        mapping: int,
        *,
        cob: int,
        mapped: tuple[int, ...] = (),
        types: frozenset[int],
        kind: int = 255,
        sent: bool,
    ) -> None:
        self._objects, self._sent, self._types = objects, sent, types
        self._defaults = (cob, kind, mapped)
        self.cob, self.kind, self.count = cob, kind, len(mapped)
        self.inhibit = self.event_time = 0  # [0.1 ms], [ms]
        self._mapped = [*mapped, *[0] * (_MOST - len(mapped))]
        objects.constant(communication, 0, 1, 5 if sent else 2)
        objects.add(communication, 1, Entry(size=4, read=lambda: self.cob, write=self._set_cob))
        objects.add(communication, 2, Entry(size=1, read=lambda: self.kind, write=self._set_kind))
        if sent:
            self._time(communication, 3, "inhibit")
            self._time(communication, 5, "event_time")
        objects.add(mapping, 0, Entry(size=1, read=lambda: self.count, write=self._set_count))
        for place in range(_MOST):
            objects.add(mapping, place + 1, self._place(place))

    def reset(self) -> None:
        """Restore the state after power-up."""
        self.cob, self.kind, mapped = self._defaults
        self.count = len(mapped)
        self.inhibit = self.event_time = 0
        self._mapped = [*mapped, *[0] * (_MOST - len(mapped))]

    @property
    def identifier(self) -> int | None:
        """COB-ID of its frames; None while it is off."""
        return None if self.cob & OFF else self.cob & 0x7FF

    @property
    def mapped(self) -> tuple[int, ...]:
        """Mapped objects: index, sub-index and bits in one number each."""
        return tuple(self._mapped[: self.count])

    def content(self) -> bytes:
        """Return the present bytes of the mapped objects."""
        return b"".join(self._objects.read(entry >> 16, entry >> 8 & 0xFF) for entry in self.mapped)

    def take(self, payload: bytes) -> None:
        """Write a frame's bytes to the mapped objects.

        Raises
        ------
        AccessError
            An object does not accept its value, or there are too few bytes.
        """
        begin = 0
        for entry in self.mapped:
            end = begin + (entry & 0xFF) // 8
            self._objects.write(entry >> 16, entry >> 8 & 0xFF, payload[begin:end])
            begin = end

    def _time(self, communication: int, subindex: int, name: str) -> None:
        def write(value: int) -> None:
            if name == "inhibit" and not self.cob & OFF:
                raise AccessError(WRONG_STATE)
            setattr(self, name, value)

        entry = Entry(size=2, read=lambda: int(getattr(self, name)), write=write)
        self._objects.add(communication, subindex, entry)

    def _place(self, place: int) -> Entry:
        return Entry(
            size=4,
            read=lambda: self._mapped[place],
            write=lambda value: self._set_place(place, value),
        )

    def _set_cob(self, value: int) -> None:
        if value & _EXTENDED or any(value & 0x7FF in reserved for reserved in _RESERVED):
            raise AccessError(OUT_OF_RANGE)
        if not (self.cob | value) & OFF and (self.cob ^ value) & 0x3FFFFFFF:
            raise AccessError(WRONG_STATE)  # the identifier changes only while the PDO is off
        self.cob = value

    def _set_kind(self, value: int) -> None:
        if value not in self._types:
            raise AccessError(OUT_OF_RANGE)
        self.kind = value

    def _set_count(self, value: int) -> None:
        if not self.cob & OFF:
            raise AccessError(WRONG_STATE)
        if value > _MOST:
            raise AccessError(TOO_MUCH_MAPPED)
        chosen = self._mapped[:value]
        if 0 in chosen:
            raise AccessError(NOT_MAPPABLE)
        if sum(entry & 0xFF for entry in chosen) > 8 * _MOST:
            raise AccessError(TOO_MUCH_MAPPED)
        self.count = value

    def _set_place(self, place: int, value: int) -> None:
        if not self.cob & OFF or self.count:
            raise AccessError(WRONG_STATE)
        if value:
            entry = self._objects.entry(value >> 16, value >> 8 & 0xFF)
            fits = (entry.sent if self._sent else entry.received) and 8 * entry.size == value & 0xFF
            if not fits:
                raise AccessError(NOT_MAPPABLE)
        self._mapped[place] = value


class TransmitPdo(Pdo):
    """A PDO that the device sends."""

    _syncs = 0
    _asked = False
    _next = 0.0  # [s], next time of the event timer

    def reset(self) -> None:
        """Restore the state after power-up."""
        super().reset()
        self._syncs, self._asked, self._next = 0, False, 0.0

    def synchronised(self) -> bool:
        """Note a SYNC. Return whether this PDO is sent in answer."""
        if self.identifier is None:
            return False
        if self.kind == 0:
            asked, self._asked = self._asked, False
            return asked
        if self.kind > 240:
            return False
        self._syncs += 1
        return self._syncs % self.kind == 0

    def event(self) -> bool:
        """Note an event that this PDO reports. Return whether it is sent at once."""
        if self.identifier is None:
            return False
        self._asked = True  # type 0: sent at the SYNC after an event
        return self.kind in EVENT

    def due(self, now: float) -> bool:
        """Return whether its event timer has run out."""
        if self.identifier is None or self.kind not in EVENT or not self.event_time:
            self._next = now
            return False
        if now < self._next:
            return False
        self._next = now + 1e-3 * self.event_time
        return True
