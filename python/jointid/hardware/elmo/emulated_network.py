"""The CANopen side of an emulated Elmo drive: network state, SDO, PDOs, heartbeats, emergencies."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import can

from jointid.hardware.can import canopen_frames as canopen
from jointid.hardware.elmo.emulated_interpreter import Interpreter
from jointid.hardware.elmo.emulated_motor import ElmoMotor
from jointid.hardware.elmo.emulated_objects import ElmoObjects
from jointid.hardware.emulated.emergencies import Emergencies
from jointid.hardware.emulated.object_dictionary import AccessError

if TYPE_CHECKING:
    from jointid.hardware.emulated.pdo import Pdo

# Bits of 2F21h: the emergencies to send.
HEARTBEAT_EVENT, MOTOR_EVENT = 3, 7
_HEARTBEAT_LOST = 0x800  # bit of MF
_PROTOCOL_EVENT, _UNCONFIGURED_EVENT, _OBJECT_EVENT = 1, 2, 8
_INTERPRETER = (0x20120040,)  # mapping of the PDO for the binary interpreter's commands


class ElmoNetwork:
    """Receive frames from the bus and send the drive's frames.

    Parameters
    ----------
    motor : ElmoMotor
    objects : ElmoObjects
    interpreter : Interpreter
    reset : callable
        Called at a reset; with True if the application is reset, too.
    """

    def __init__(
        self,
        motor: ElmoMotor,
        objects: ElmoObjects,
        interpreter: Interpreter,
        reset: Callable[[bool], None],
    ) -> None:
        self._motor, self._objects, self._interpreter = motor, objects, interpreter
        self._reset = reset
        self.state = "pre-operational"
        self.emergencies = Emergencies(motor.settings.node, objects, self._alarm)
        self._at_sync: dict[int, bytes] = {}  # payloads of received PDOs that wait for a SYNC
        self._heartbeat_seen: float | None = None
        self._silent = False  # whether the host's heartbeat is missing
        self._next_heartbeat = 0.0

    def boot(self) -> None:
        """Send the boot-up message."""
        self.send(canopen.heartbeat_id(self._motor.settings.node), b"\x00")

    def receive(self, message: can.Message) -> None:
        """Take a frame from the bus."""
        node = self._motor.settings.node
        if message.is_remote_frame or message.is_extended_id or message.is_error_frame:
            return
        identifier, payload = message.arbitration_id, bytes(message.data)
        if identifier == canopen.NMT:
            if len(payload) == 2 and payload[1] in (0, node):
                self.command(payload[0])
        elif identifier == canopen.SYNC:
            self._synchronise()
        elif identifier == 0x600 + node:
            answer = self._objects.answer(payload) if self.state != "stopped" else None
            if answer is not None:
                self.send(0x580 + node, answer)
        elif identifier == canopen.heartbeat_id(self._objects.master):
            self._heartbeat()
        elif self.state == "operational":
            for number, pdo in enumerate(self._objects.received):
                if pdo.identifier == identifier:
                    self._take(number, pdo, payload)

    def command(self, command: int) -> None:
        """Execute a network command."""
        if command == canopen.START:
            self.state = "operational"
        elif command == canopen.STOP:
            self._stop()
        elif command == canopen.PRE_OPERATIONAL:
            self.state = "pre-operational"
        elif command in (canopen.RESET_NODE, canopen.RESET_COMMUNICATION):
            self.abort_connection()
            self.state = "pre-operational"
            self.forget_heartbeat()
            self._at_sync.clear()
            self.emergencies.forget()
            self._reset(command == canopen.RESET_NODE)
            self.boot()
        else:
            self._alert(_PROTOCOL_EVENT, 0x8200, 0x11)

    def forget_heartbeat(self) -> None:
        """Wait again for the first heartbeat of the host."""
        self._heartbeat_seen, self._silent = None, False

    def reply(self, payload: bytes) -> None:
        """Publish a result of the interpreter."""
        objects = self._objects
        objects.result = payload
        for number, pdo in enumerate(objects.sent):
            if objects.replies(number) and self.state == "operational" and pdo.event():
                self._send_pdo(pdo.identifier, pdo.content())

    def look(self, now: float) -> None:
        """Check the timers: the host's heartbeat, the drive's own heartbeat, event timers."""
        objects = self._objects
        seen, allowed = self._heartbeat_seen, objects.consumer_time
        if seen is not None and allowed and now - seen > allowed:
            self._heartbeat_lost()
        if objects.producer_time and now >= self._next_heartbeat:
            self._next_heartbeat = now + objects.producer_time
            if not self._motor.silent_heartbeat:
                state = next(n for n, name in canopen.STATES.items() if name == self.state)
                self.send(canopen.heartbeat_id(self._motor.settings.node), bytes((state,)))
        for pdo in objects.sent:
            if pdo.due(now) and self.state == "operational":
                self._send_pdo(pdo.identifier, pdo.content())

    def send(self, identifier: int, payload: bytes) -> None:
        """Send a frame on the bus."""
        self._motor.bus.transmit(
            can.Message(arbitration_id=identifier, data=payload, is_extended_id=False)
        )

    # The host.

    def _heartbeat(self) -> None:
        if self._objects.consumer_time <= 0.0:
            return
        self._heartbeat_seen = self._motor.bus.now()
        if self._silent:
            self._silent = False
            if not self._motor.failure:
                self.emergencies.vanish()

    def _heartbeat_lost(self) -> None:
        """Apply 6007h to the motor, 2F21h to the emergency and 1029h to the network state."""
        self._heartbeat_seen, self._silent = None, True
        self.lose_host()
        self._alert(HEARTBEAT_EVENT, 0x8130, 0x11)
        behaviour = self._objects.value(0x1029, 1)
        if behaviour == 0 and self.state == "operational":
            self.state = "pre-operational"
        elif behaviour == 2:
            self._stop()

    def _stop(self) -> None:
        self.state = "stopped"
        self.abort_connection()

    def lose_host(self) -> None:
        """React to a missing host heartbeat: apply 6007h to the motor."""
        if self._objects.value(0x6007, 0):
            self._motor.advance()
            self._motor.switch(on=False)
            self._motor.failure = _HEARTBEAT_LOST

    def abort_connection(self) -> None:
        """React to a stop or reset of the node: apply 6007h to the motor (CiA 402)."""
        option = self._objects.value(0x6007, 0)
        if option and self._motor.motor_on:
            self._motor.switch(on=False)
            if option == 1:
                self._motor.failure = _HEARTBEAT_LOST

    # PDOs.

    def _synchronise(self) -> None:
        if self.state != "operational":
            return
        objects = self._objects
        for number, payload in tuple(self._at_sync.items()):
            del self._at_sync[number]
            self._write(objects.received[number], payload)
        for pdo in objects.sent:
            if pdo.synchronised():
                self._send_pdo(pdo.identifier, pdo.content())

    def _take(self, number: int, pdo: Pdo, payload: bytes) -> None:
        if pdo.kind == 1:
            self._at_sync[number] = payload  # a later payload replaces it
        else:
            self._write(pdo, payload)

    def _write(self, pdo: Pdo, payload: bytes) -> None:
        if pdo.mapped == _INTERPRETER:  # its commands have four or eight bytes
            self._interpreter.take(payload)
        elif not pdo.mapped or 8 * len(payload) < sum(entry & 0xFF for entry in pdo.mapped):
            self._alert(_UNCONFIGURED_EVENT, 0x8210, 0x21)
        else:
            try:
                pdo.take(payload)
            except AccessError:
                self._alert(_OBJECT_EVENT, 0x6300, 0x01)

    def _send_pdo(self, identifier: int | None, payload: bytes) -> None:
        if identifier is not None:
            self.send(identifier, payload)

    # Emergencies.

    def _alert(self, event: int, code: int, register: int) -> None:
        self.emergencies.appear(code, register, told=self._objects.emergency_wanted(event))

    def _alarm(self, identifier: int, payload: bytes) -> None:
        if self.state != "stopped":
            self.send(identifier, payload)
