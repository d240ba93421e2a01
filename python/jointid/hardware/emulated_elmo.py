"""An Elmo SimplIQ drive that is not there: the same frames, limits and refusals, moving a simulated joint."""

from __future__ import annotations

import math
import struct
from collections import deque
from dataclasses import dataclass
from typing import TYPE_CHECKING

import can

from jointid.errors import InputError
from jointid.hardware import canopen_frames as canopen
from jointid.hardware.elmo_codec import Command, Reply, refusal
from jointid.hardware.torque_source import SensorScaling

if TYPE_CHECKING:
    from jointid._core import SteppedJoint
    from jointid.hardware.device import DeviceBus

TWO_PI = 2.0 * math.pi
_PERIOD_OF_GUARDS = 0.5e-3  # [s] between looks at speed and heartbeat
_MAPPABLE = {0x60640020: "position", 0x60690020: "velocity", 0x606C0020: "velocity"}
_MAPPABLE |= {0x60770010: "torque"}


@dataclass(frozen=True, slots=True, kw_only=True)
class ElmoSettings:
    """What an emulated drive is, and how it has been set.

    Attributes
    ----------
    node : int
    counts_per_turn : int
        Encoder counts of a motor turn.
    gear_ratio, torque_constant : float
        Motor's angle per output angle; [N·m/A].
    peak_current, continuous_current : float
        PL[1], CL[1] [A].
    speed_limit : float
        HL[2], motor counts a second; beyond, it shuts down.
    idle_loop : float
        Time between two interpreter commands [s].
    mantissa_bits : int
        Of the current command that count; 24 is a float's own, 4 the thesis's link.
    position_offset : float
        Output angle at count 0 [rad].
    analog : SensorScaling
        Between the torque sensor's reading and the voltage at the analog input.
    """

    node: int = 127
    counts_per_turn: int = 8000
    gear_ratio: float = 101.0
    torque_constant: float = 0.198
    peak_current: float = 8.0
    continuous_current: float = 8.0
    speed_limit: float = 1e9
    idle_loop: float = 0.3e-3
    mantissa_bits: int = 24
    position_offset: float = 0.0
    analog: SensorScaling = SensorScaling()


class EmulatedElmo:
    """One drive with its motor, gear, joint and encoder.

    Parameters
    ----------
    joint : SteppedJoint
        Moved by the motor.
    settings : ElmoSettings
    """

    def __init__(self, joint: SteppedJoint, settings: ElmoSettings | None = None) -> None:
        self.settings = settings if settings is not None else ElmoSettings()
        self.joint = joint
        self.state = "pre-operational"
        self.motor_on = False
        self.unit_mode = 5
        self.reference_mode = 1
        self.current = 0.0
        self.failure = 0
        self.last_error = 0
        self.stuck_encoder: int | None = None
        self.saturated = False
        self._bus: DeviceBus | None = None
        self._waiting: deque[Command] = deque()
        self._busy_until = 0.0
        self._time = 0.0
        self._objects = {0x1018_01: 0x9A, 0x1018_02: 0x00030924, 0x1018_03: 0x01010301}
        self._mapping: list[str] = []
        self._position_cob = 0xC0000000 | (0x480 + self.settings.node)
        self._sync_every = 0
        self._syncs = 0
        self._heartbeat_seen: float | None = None
        self._limits = [self.settings.peak_current, self.settings.continuous_current]
        self.torque_commands: list[tuple[float, float]] = []

    @property
    def bus(self) -> DeviceBus:
        """The bus that it hangs on."""
        assert self._bus is not None, "attach the drive to a bus"
        return self._bus

    def attach(self, bus: DeviceBus) -> None:
        """Power up: a boot-up message, then guards look at speed and heartbeat."""
        self._bus = bus
        self._send(canopen.heartbeat_id(self.settings.node), b"\x00")
        bus.at(bus.now() + _PERIOD_OF_GUARDS, self._guard)

    def receive(self, message: can.Message) -> None:
        """A frame has arrived."""
        self.advance()
        node, payload = self.settings.node, bytes(message.data)
        identifier = message.arbitration_id
        if identifier == canopen.NMT and len(payload) == 2 and payload[1] in (0, node):
            self._network(payload[0])
        elif identifier == canopen.SYNC:
            self._synchronise()
        elif identifier == 0x300 + node and self.state == "operational":
            self._queue(payload)
        elif identifier == 0x600 + node and self.state != "stopped":
            self._object(payload)
        elif identifier == canopen.heartbeat_id(self._master()) and self._consumer_time() > 0.0:
            self._heartbeat_seen = self.bus.now()

    def advance(self) -> None:
        """Bring the joint to the bus's time."""
        now = self.bus.now()
        duration = now - self._time
        if duration > 0.0:
            torque = self.current if self.motor_on else 0.0
            torque *= self.settings.torque_constant * self.settings.gear_ratio
            self.joint.advance(torque, duration)
            self._time = now

    def counts(self) -> int:
        """Encoder counts of the motor, which an encoder that hangs repeats."""
        if self.stuck_encoder is not None:
            return self.stuck_encoder
        angle = self.joint.position - self.settings.position_offset
        per_turn = self.settings.counts_per_turn * self.settings.gear_ratio
        return math.floor(angle / TWO_PI * per_turn)

    def fail(self, failure: int, emergency: int) -> None:
        """Shut the motor down, with a failure in MF and an emergency on the bus."""
        self.advance()
        self.motor_on = False
        self.current = 0.0
        self.failure = failure
        payload = struct.pack("<HBBHH", emergency, 0x81, 0, 0, 0)
        self._send(canopen.emergency_id(self.settings.node), payload)

    # The network.

    def _network(self, command: int) -> None:
        node = self.settings.node
        if command == canopen.START:
            self.state = "operational"
        elif command == canopen.STOP:
            self.state = "stopped"
        elif command == canopen.PRE_OPERATIONAL:
            self.state = "pre-operational"
        elif command in (canopen.RESET_NODE, canopen.RESET_COMMUNICATION):
            self.state = "pre-operational"
            self._heartbeat_seen = None
            self._mapping, self._sync_every = [], 0
            self._objects = {k: v for k, v in self._objects.items() if k >> 8 == 0x1018}
            if command == canopen.RESET_NODE:
                self.motor_on, self.current, self.unit_mode = False, 0.0, 5
            self._send(canopen.heartbeat_id(node), b"\x00")

    def _synchronise(self) -> None:
        if self.state != "operational" or not self._sync_every or self._position_cob >> 31:
            return
        self._syncs += 1
        if self._syncs % self._sync_every == 0:
            self._send(self._position_cob & 0x7FF, self._mapped())

    def _mapped(self) -> bytes:
        parts = []
        for name in self._mapping:
            if name == "position":
                parts.append(struct.pack("<i", self.counts()))
            elif name == "velocity":
                parts.append(struct.pack("<i", self._speed()))
            else:
                share = 1000.0 * self.current / self.settings.continuous_current
                parts.append(struct.pack("<h", round(max(-32768.0, min(32767.0, share)))))
        return b"".join(parts)[:8]

    def _speed(self) -> int:
        per_radian = self.settings.counts_per_turn * self.settings.gear_ratio / TWO_PI
        return round(self.joint.velocity * per_radian)

    # Objects.

    def _object(self, payload: bytes) -> None:
        node = self.settings.node
        try:
            request = canopen.SdoRequest.of(payload)
        except InputError:
            return
        key = request.index << 8 | request.subindex
        if request.value is None:
            if key in self._objects:
                answer = canopen.sdo_answer(request, self._objects[key])
            else:
                answer = canopen.sdo_abort(request, 0x06020000)
        else:
            answer = self._assign_object(request, key)
        self._send(0x580 + node, answer)

    def _assign_object(self, request: canopen.SdoRequest, key: int) -> bytes:
        value = request.value or 0
        if key == 0x1803_01:
            self._position_cob = value
        elif key == 0x1803_02:
            self._sync_every = value if 1 <= value <= 240 else 0
        elif key == 0x1A03_00:
            if value and not self._position_cob >> 31:
                return canopen.sdo_abort(request, 0x08000022)
            self._mapping = self._mapping[:value]
        elif request.index == 0x1A03:
            if value not in _MAPPABLE:
                return canopen.sdo_abort(request, 0x06040041)
            self._mapping = [*self._mapping[: request.subindex - 1], _MAPPABLE[value]]
        elif request.index in (0x1803, 0x1018):
            return canopen.sdo_abort(request, 0x06010000)
        self._objects[key] = value
        return canopen.sdo_answer(request)

    # The interpreter.

    def _queue(self, payload: bytes) -> None:
        """Commands wait for the drive's idle loop, one after the other."""
        try:
            command = Command.of(payload)
        except InputError:
            self._refuse(payload[:2].decode("latin-1").ljust(2, "?"), 0, 2)
            return
        self._waiting.append(command)
        now = self.bus.now()
        self._busy_until = max(now, self._busy_until) + self.settings.idle_loop
        self.bus.at(self._busy_until, self._interpret)

    def _interpret(self) -> None:
        self.advance()
        if not self._waiting:
            return
        command = self._waiting.popleft()
        error = self._error(command)
        if error:
            self._refuse(command.letters, command.index, error)
            return
        value = self._act(command)
        reply = Reply(letters=command.letters, index=command.index, value=value)
        if command.letters != "TC" or self._objects.get(0x2F20_02, 0x80000000):
            self._send(0x280 + self.settings.node, reply.payload())

    def _error(self, command: Command) -> int:
        """EC of what is wrong with a command, 0 if nothing."""
        letters, value = command.letters, command.value
        known = {"MO", "UM", "RM", "TC", "PX", "VX", "IQ", "ID", "PL", "CL", "SR", "MF", "EC", "ST"}
        if letters not in known | {"HL", "AN", "MS"}:
            return 2
        if letters in ("PL", "CL", "HL", "AN") and command.index not in (1, 2):
            return 3
        if value is None:
            return 0
        rules = {
            "UM": (57 if self.motor_on else 0) or (0 if value in (1, 2, 3, 4, 5) else 21),
            "TC": (0 if self.motor_on else 58) or (0 if self.unit_mode == 1 else 60),
            "MO": 0 if value in (0, 1) else 21,
            "PX": 57 if self.motor_on else 0,
            "IQ": 23,
            "ID": 23,
            "SR": 23,
            "MF": 23,
            "VX": 23,
            "AN": 23,
        }
        error = rules.get(letters, 0)
        if not error and letters == "TC" and abs(value) > self._limits[0] + 1e-6:
            return 21
        if not error and letters == "MO" and value == 1 and self.state != "operational":
            return 66
        return error

    def _act(self, command: Command) -> int | float:
        letters, value = command.letters, command.value
        if value is None:
            return self._read(letters, command.index)
        if letters == "MO":
            self.motor_on = bool(value)
            self.current = 0.0
            if value:
                self.failure = 0
        elif letters == "TC":
            self.current = self._quantised(float(value))
            self.torque_commands.append((self.bus.now(), self.current))
        elif letters == "UM":
            self.unit_mode = int(value)
        elif letters == "RM":
            self.reference_mode = int(value)
        elif letters in ("PL", "CL") and command.index == 1:
            self._limits[letters == "CL"] = float(value)
        return value

    def _read(self, letters: str, index: int) -> int | float:
        if letters == "ST":
            self.current = 0.0
            return 0
        readings: dict[str, int | float] = {
            "MO": int(self.motor_on),
            "UM": self.unit_mode,
            "RM": self.reference_mode,
            "TC": float(self.current),
            "PX": self.counts(),
            "VX": self._speed(),
            "IQ": float(self.current if self.motor_on else 0.0),
            "ID": 0.0,
            "PL": float(self._limits[0] if index == 1 else 3.0),
            "CL": float(self._limits[1]),
            "HL": int(self.settings.speed_limit),
            "SR": self._status(),
            "MF": self.failure,
            "EC": self.last_error,
            "AN": self._analog(),
            "MS": 0,
        }
        return readings[letters]

    def _analog(self) -> float:
        reading = self.joint.observe().reading
        return self.settings.analog.voltage(reading, self.joint.position)

    def _status(self) -> int:
        return (
            0x10 * self.motor_on
            | 0x40 * bool(self.failure)
            | self.unit_mode << 7
            | 0x2000 * (abs(self.current) > self._limits[1])
        )

    def _quantised(self, current: float) -> float:
        bits = self.settings.mantissa_bits
        if bits >= 24 or current == 0.0:
            return current
        mantissa, exponent = math.frexp(current)
        return math.ldexp(math.trunc(mantissa * 2**bits) / 2**bits, exponent)

    def _refuse(self, letters: str, index: int, code: int) -> None:
        self.last_error = code
        self._send(0x280 + self.settings.node, refusal(letters, index, code))

    # Guards.

    def _master(self) -> int:
        return self._objects.get(0x1016_01, 0) >> 16 & 0x7F

    def _consumer_time(self) -> float:
        return (self._objects.get(0x1016_01, 0) & 0xFFFF) * 1e-3

    def _guard(self) -> None:
        self.advance()
        if self.motor_on and abs(self._speed()) > self.settings.speed_limit:
            self.fail(0x20000, 0x8481)
        seen, allowed = self._heartbeat_seen, self._consumer_time()
        if seen is not None and allowed and self.bus.now() - seen > allowed:
            self._heartbeat_seen = None
            self.fail(0x800, 0x8130)
        self.bus.at(self.bus.now() + _PERIOD_OF_GUARDS, self._guard)

    def _send(self, identifier: int, payload: bytes) -> None:
        self.bus.transmit(
            can.Message(arbitration_id=identifier, data=payload, is_extended_id=False)
        )
