"""The binary and the text interpreter of an emulated drive: command queue, refusals, answers."""

from __future__ import annotations

import math
import re
import struct
from collections import deque
from collections.abc import Callable
from random import Random

from jointid.base.errors import InputError
from jointid.hardware.elmo.codec import Command, Reply, refusal
from jointid.hardware.elmo.emulated_motor import ElmoMotor
from jointid.hardware.elmo.emulated_registers import (
    BAD_COMMAND,
    BAD_INDEX,
    NO_MEANING,
    NOT_ASSIGNED,
    Number,
    registers,
)

VERSION = "Cello 2.02.00.00 emulated"
_TEXTS = {"VR": VERSION}  # values that do not fit in four bytes
_TEXT = re.compile(r"([A-Z]{2})(?:\[(\d+)\])?(?:=([-+.\deE]+))?;?\s*")
# Status of 1023h:2.
NO_REPLY, REPLY, ERROR_REPLY = 0, 1, 3


class Interpreter:
    """Execute one command after the other, in the drive's idle loop.

    Parameters
    ----------
    motor : ElmoMotor
    identity : callable
        As in `registers`.
    reply : callable
        Publishes a result.
    """

    def __init__(
        self,
        motor: ElmoMotor,
        identity: Callable[[int], int],
        reply: Callable[[bytes], None],
    ) -> None:
        self._motor, self._reply = motor, reply
        self._registers = registers(motor, identity, lambda: self.last_error)
        self._waiting: deque[Command] = deque()
        self._busy = False
        self._random = Random(motor.settings.node)
        self.last_error = 0
        self.text_status, self.text = NO_REPLY, b""

    def forget(self) -> None:
        """Drop the waiting commands, as a restart does."""
        self._waiting.clear()

    def take(self, payload: bytes) -> None:
        """Queue the frame of a binary command until the idle loop runs."""
        try:
            command = Command.of(payload)
        except InputError:
            self._refuse(payload[:2].decode("latin-1").ljust(2, "?"), 0, BAD_COMMAND)
            return
        self._waiting.append(command)
        if not self._busy:
            self._begin()

    def take_text(self, given: bytes) -> None:
        """Execute a command of the text interpreter, e.g. ``VR`` or ``PL[1]``, and keep its answer."""
        wording = given.rstrip(b"\0").decode("latin-1").strip().upper()
        match = _TEXT.fullmatch(wording)
        if match is None:
            self.text_status, self.text = ERROR_REPLY, f"{BAD_COMMAND};".encode("ascii")
            return
        letters, index, value = match[1], int(match[2] or 0), match[3]
        if letters in _TEXTS and value is None:
            self.text_status, self.text = REPLY, f"{_TEXTS[letters]};".encode("ascii")
            return
        try:
            number: Number | None = None if value is None else _number(value)
        except ValueError:
            self.text_status, self.text = ERROR_REPLY, f"{BAD_COMMAND};".encode("ascii")
            return
        self._motor.advance()
        error, found = self._done(letters, index, number)
        if error:
            self.last_error = error
        self.text_status = ERROR_REPLY if error else REPLY
        self.text = f"{error if error else found};".encode("ascii")

    def _begin(self) -> None:
        motor = self._motor
        self._busy = True
        jitter = motor.settings.idle_jitter
        late = self._random.uniform(0.0, jitter) if jitter else 0.0
        motor.bus.at(motor.bus.now() + motor.settings.idle_loop + late, self._interpret)

    def _interpret(self) -> None:
        enabling = self._motor.settings.enable_time
        if self._waiting and enabling and self._waiting[0].letters == "MO":
            command = self._waiting[0]
            if command.value == 1 and not self._motor.motor_on:
                self._motor.bus.at(self._motor.bus.now() + enabling, self._act)
                return
        self._act()

    def _act(self) -> None:
        self._motor.advance()
        self._busy = False
        if not self._waiting:
            return
        command = self._waiting.popleft()
        error, value = self._done(command.letters, command.index, command.value)
        if error:
            self._refuse(command.letters, command.index, error)
        else:
            self._reply(_payload(command, value))
        if self._waiting:
            self._begin()

    def _done(self, letters: str, index: int, value: Number | None) -> tuple[int, Number]:
        """Read or assign a value. Return EC (0: no error) and the answer's value."""
        register = self._registers.get(letters)
        if register is None:
            return (NO_MEANING if letters in _TEXTS else BAD_COMMAND), 0
        if index not in register.indices:
            return BAD_INDEX, 0
        if value is None:
            return 0, register.read(index)
        if register.write is None:
            return NOT_ASSIGNED, 0
        return register.write(index, value), value

    def _refuse(self, letters: str, index: int, code: int) -> None:
        self.last_error = code
        self._reply(refusal(letters, index, code))


def _number(wording: str) -> Number:
    return float(wording) if set(wording) & set(".eE") else int(wording)


def _payload(command: Command, value: int | float) -> bytes:
    """Return the bytes of a reply, also for a value that is not finite."""
    if isinstance(value, float) and not math.isfinite(value):
        head = Reply(letters=command.letters, index=command.index, value=0.0).payload()[:4]
        return head + struct.pack("<f", value)
    return Reply(letters=command.letters, index=command.index, value=value).payload()
