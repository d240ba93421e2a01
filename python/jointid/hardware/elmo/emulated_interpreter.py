"""The binary interpreter of an emulated drive: what it refuses, what it does, what it answers."""

from __future__ import annotations

import math
import struct
from collections import deque
from typing import TYPE_CHECKING

from jointid.base.errors import InputError
from jointid.hardware.elmo.codec import Command, Reply, refusal

if TYPE_CHECKING:
    from jointid.hardware.elmo.emulated_drive import EmulatedElmo

_KNOWN = {"MO", "UM", "RM", "TC", "PX", "VX", "IQ", "ID", "PL", "CL", "SR", "MF", "EC", "ST"}
_KNOWN |= {"HL", "AN", "MS"}
_INDEXED = ("PL", "CL", "HL", "AN")
_READ_ONLY = ("IQ", "ID", "SR", "MF", "VX", "AN")


class Interpreter:
    """Takes one command after the other, in the drive's idle loop.

    Parameters
    ----------
    drive : EmulatedElmo
    """

    def __init__(self, drive: EmulatedElmo) -> None:
        self._drive = drive
        self._waiting: deque[Command] = deque()
        self._busy_until = 0.0
        self.last_error = 0

    def forget(self) -> None:
        """What waits is lost with a restart."""
        self._waiting.clear()

    def take(self, payload: bytes) -> None:
        """A command's frame has arrived; it waits for the idle loop."""
        drive = self._drive
        try:
            command = Command.of(payload)
        except InputError:
            self._refuse(payload[:2].decode("latin-1").ljust(2, "?"), 0, 2)
            return
        self._waiting.append(command)
        now = drive.bus.now()
        self._busy_until = max(now, self._busy_until) + drive.settings.idle_loop
        drive.bus.at(self._busy_until, self._interpret)

    def _interpret(self) -> None:
        drive = self._drive
        drive.advance()
        if not self._waiting:
            return
        command = self._waiting.popleft()
        error = self._error(command)
        if error:
            self._refuse(command.letters, command.index, error)
            return
        value = self._act(command)
        drive.reply(_payload(command, value))

    def _error(self, command: Command) -> int:
        """EC of what is wrong with a command, 0 if nothing."""
        drive = self._drive
        letters, value = command.letters, command.value
        if letters not in _KNOWN:
            return 2
        if letters in _INDEXED and command.index not in (1, 2):
            return 3
        if value is None:
            return 0
        if letters in _READ_ONLY:
            return 23
        if letters == "UM":
            return 57 if drive.motor_on else 0 if value in (1, 2, 3, 4, 5) else 21
        if letters == "PX":
            return 57 if drive.motor_on else 0
        if letters == "MO":
            return 21 if value not in (0, 1) else 66 if value and drive.problem else 0
        if letters == "TC":
            if not drive.motor_on:
                return 58
            if drive.unit_mode != 1:
                return 60
            return 21 if abs(value) > drive.current_limits[0] + 1e-6 else 0
        return 0

    def _act(self, command: Command) -> int | float:
        drive = self._drive
        letters, value = command.letters, command.value
        if value is None:
            return self._read(letters, command.index)
        if letters == "MO":
            drive.switch(on=bool(value))
        elif letters == "TC":
            drive.current = drive.stage_gain * self._quantised(float(value))
            drive.torque_commands.append((drive.bus.now(), drive.current))
        elif letters == "UM" and drive.fixed_unit_mode is None:
            drive.unit_mode = int(value)
        elif letters == "PX":
            drive.count_offset += int(value) - drive.counts()
        elif letters == "RM":
            drive.reference_mode = int(value)
        elif letters in ("PL", "CL") and command.index == 1:
            drive.current_limits[letters == "CL"] = float(value)
        return value

    def _read(self, letters: str, index: int) -> int | float:
        drive = self._drive
        if letters == "ST":
            drive.current = 0.0
            return 0
        readings: dict[str, int | float] = {
            "MO": int(drive.motor_on),
            "UM": drive.unit_mode,
            "RM": drive.reference_mode,
            "TC": float(drive.current),
            "PX": drive.counts(),
            "VX": drive.speed(),
            "IQ": float(drive.current if drive.motor_on else 0.0),
            "ID": 0.0,
            "PL": float(drive.current_limits[0] if index == 1 else 3.0),
            "CL": float(drive.current_limits[1]),
            "HL": int(drive.settings.speed_limit),
            "SR": drive.status(),
            "MF": drive.failure,
            "EC": self.last_error,
            "AN": drive.voltage(),
            "MS": 0,
        }
        return readings[letters]

    def _quantised(self, current: float) -> float:
        bits = self._drive.settings.mantissa_bits
        if bits >= 24 or current == 0.0:
            return current
        mantissa, exponent = math.frexp(current)
        return math.ldexp(math.trunc(mantissa * 2**bits) / 2**bits, exponent)

    def _refuse(self, letters: str, index: int, code: int) -> None:
        self.last_error = code
        self._drive.reply(refusal(letters, index, code))


def _payload(command: Command, value: int | float) -> bytes:
    """A reply's bytes, also of a value that is not finite."""
    if isinstance(value, float) and not math.isfinite(value):
        head = Reply(letters=command.letters, index=command.index, value=0.0).payload()[:4]
        return head + struct.pack("<f", value)
    return Reply(letters=command.letters, index=command.index, value=value).payload()
