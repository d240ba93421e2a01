"""Error register, error history and emergency messages of an emulated CANopen device (CiA 301)."""

from __future__ import annotations

import struct
from collections.abc import Callable

from jointid.hardware.can.canopen_frames import emergency_id
from jointid.hardware.emulated.object_dictionary import (
    NOTHING_THERE,
    OUT_OF_RANGE,
    AccessError,
    Entry,
    ObjectDictionary,
)

_LONGEST = 8  # number of stored errors


class Emergencies:
    """Report a device's errors on the bus when they appear and when they are gone.

    Add 1001h, 1003h and 1014h to the device's object dictionary.

    Parameters
    ----------
    node : int
    objects : ObjectDictionary
    send : callable
        Sends a frame: identifier and payload.
    """

    def __init__(
        self, node: int, objects: ObjectDictionary, send: Callable[[int, bytes], None]
    ) -> None:
        self._identifier, self._send = emergency_id(node), send
        self.register = 0
        self._history: list[int] = []
        objects.add(0x1001, 0, Entry(size=1, read=lambda: self.register, sent=True))
        objects.add(
            0x1003, 0, Entry(size=1, read=lambda: len(self._history), write=self._clear_history)
        )
        for place in range(_LONGEST):
            objects.add(0x1003, place + 1, Entry(size=4, read=lambda at=place: self._kept(at)))  # type: ignore[misc]
        objects.constant(0x1014, 0, 4, self._identifier)

    def appear(self, code: int, register: int, *, told: bool = True) -> None:
        """Note an error and report it on the bus.

        Parameters
        ----------
        code : int
            Code of the emergency.
        register : int
            Bits of the error register.
        told : bool
            Whether an emergency is sent. Default True.
        """
        self.register |= register
        self._history = [code, *self._history][:_LONGEST]
        if told:
            self._send(self._identifier, struct.pack("<HB5x", code, self.register))

    def vanish(self) -> None:
        """Report on the bus that no error is left, if there was one."""
        if self.register:
            self.register = 0
            self._send(self._identifier, bytes(8))

    def forget(self) -> None:
        """Clear all errors without a message, as after power-up."""
        self.register, self._history = 0, []

    def _clear_history(self, value: int) -> None:
        if value:
            raise AccessError(OUT_OF_RANGE)
        self._history = []

    def _kept(self, place: int) -> int:
        if place >= len(self._history):
            raise AccessError(NOTHING_THERE)
        return self._history[place]
