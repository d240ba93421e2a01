"""An emulated Elmo SimplIQ drive: the same frames, limits and refusals, moving a simulated joint."""

from __future__ import annotations

import math
import struct
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import can

from jointid.hardware.can import canopen_frames as canopen
from jointid.hardware.elmo.emulated_interpreter import Interpreter
from jointid.hardware.elmo.emulated_objects import ObjectDictionary
from jointid.hardware.elmo.torque_source import SensorScaling
from jointid.hardware.emulated.faults import drive_failure

if TYPE_CHECKING:
    from jointid._core import SteppedJoint
    from jointid.hardware.emulated.device import DeviceBus

TWO_PI = 2.0 * math.pi
_PERIOD_OF_GUARDS = 0.5e-3  # [s] between looks at speed and heartbeat


@dataclass(frozen=True, slots=True, kw_only=True)
class ElmoSettings:
    """Properties and settings of an emulated drive.

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
    cob_command, cob_reply : int, optional
        COB-IDs of interpreter commands and replies. Default: 0x300 and 0x280 plus the node.
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
    analog: SensorScaling = field(default_factory=SensorScaling)
    cob_command: int | None = None
    cob_reply: int | None = None

    @property
    def command_id(self) -> int:
        """COB-ID of interpreter commands."""
        return self.cob_command if self.cob_command is not None else 0x300 + self.node

    @property
    def reply_id(self) -> int:
        """COB-ID of interpreter replies."""
        return self.cob_reply if self.cob_reply is not None else 0x280 + self.node


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
        self.objects = ObjectDictionary(self.settings.node)
        self.state = "pre-operational"
        self.motor_on = False
        self.unit_mode = 5
        self.reference_mode = 1
        self.current = 0.0
        self.current_limits = [self.settings.peak_current, self.settings.continuous_current]
        self.failure = 0
        self.problem = 0  # of the power stage, as in SR
        # Faults on demand; set them at a time with the bus's `at`.
        self.stuck_encoder: int | None = None
        self.count_offset = 0  # since PX was set
        self.slipped_counts = 0
        self.fixed_unit_mode: int | None = None
        self.stage_gain = 1.0
        self.stuck_voltage: float | None = None
        self.silent_heartbeat = False
        # What has happened, for tests.
        self.torque_commands: list[tuple[float, float]] = []
        self.switchings: list[tuple[float, bool]] = []
        self._bus: DeviceBus | None = None
        self._interpreter = Interpreter(self)
        self._time = 0.0
        self._syncs = 0
        self._heartbeat_seen: float | None = None
        self._next_heartbeat = 0.0

    @property
    def bus(self) -> DeviceBus:
        """The bus to which it is connected."""
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
        elif identifier == self.settings.command_id and self.state == "operational":
            self._interpreter.take(payload)
        elif identifier == 0x600 + node and self.state != "stopped":
            answer = self.objects.answer(payload)
            if answer is not None:
                self._send(0x580 + node, answer)
        elif (
            identifier == canopen.heartbeat_id(self.objects.master)
            and self.objects.consumer_time > 0.0
        ):
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
        """Encoder counts of the motor; an encoder that hangs repeats them."""
        if self.stuck_encoder is not None:
            return self.stuck_encoder
        angle = self.joint.position - self.settings.position_offset
        per_turn = self.settings.counts_per_turn * self.settings.gear_ratio
        return math.floor(angle / TWO_PI * per_turn) + self.slipped_counts + self.count_offset

    def speed(self) -> int:
        """Of the motor [counts/s]."""
        per_radian = self.settings.counts_per_turn * self.settings.gear_ratio / TWO_PI
        return round(self.joint.velocity * per_radian)

    def voltage(self) -> float:
        """At the analog input [V]."""
        if self.stuck_voltage is not None:
            return self.stuck_voltage
        reading = self.joint.observe().reading
        return self.settings.analog.voltage(reading, self.joint.position)

    def condition(self) -> dict[str, Any]:
        """What a `Journal` tells: state, motor and failure (MF) as events, and where the joint is."""
        return {
            "events": {
                "state": self.state,
                "motor_on": self.motor_on,
                "failure": self.failure,
            },
            "current": self.current,
            "position": self.joint.position,
            "velocity": self.joint.velocity,
            "commands": len(self.torque_commands),
        }

    def status(self) -> int:
        """SR."""
        return (
            bool(self.problem)
            | self.problem << 1
            | 0x10 * self.motor_on
            | 0x40 * bool(self.failure)
            | self.unit_mode << 7
            | 0x2000 * (abs(self.current) > self.current_limits[1])
        )

    def switch(self, *, on: bool) -> None:
        """Motor on or off, at no current."""
        if on != self.motor_on:
            self.switchings.append((self.bus.now(), on))
        self.motor_on, self.current = on, 0.0
        if on:
            self.failure = 0

    def fail(self, kind: str) -> None:
        """Shut the motor down, with a failure in MF and an emergency on the bus.

        Parameters
        ----------
        kind : str
            One of `faults.DRIVE_FAILURES`.
        """
        self.advance()
        failure, emergency = drive_failure(kind)
        self.switch(on=False)
        self.failure = failure
        self.problem = failure >> 13 & 0x7 if failure & 0x1000 else 0
        payload = struct.pack("<HBBHH", emergency, 0x81, 0, 0, 0)
        self._send(canopen.emergency_id(self.settings.node), payload)

    def restart(self) -> None:
        """As if its supply had failed for a moment."""
        self.advance()
        self.failure = self.problem = 0
        self._network(canopen.RESET_NODE)

    def reply(self, payload: bytes) -> None:
        """Send a reply of the interpreter's."""
        self._send(self.settings.reply_id, payload)

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
            self.objects.reset()
            self._interpreter.forget()
            if command == canopen.RESET_NODE:
                self.switch(on=False)
                self.unit_mode = 5
            self._send(canopen.heartbeat_id(node), b"\x00")

    def _synchronise(self) -> None:
        identifier = self.objects.position_id
        if self.state != "operational" or identifier is None:
            return
        self._syncs += 1
        if self._syncs % self.objects.sync_every == 0:
            self._send(identifier, self._mapped())

    def _mapped(self) -> bytes:
        parts = []
        for name in self.objects.mapping:
            if name == "position":
                parts.append(struct.pack("<i", self.counts()))
            elif name == "velocity":
                parts.append(struct.pack("<i", self.speed()))
            else:
                share = 1000.0 * self.current / self.settings.continuous_current
                parts.append(struct.pack("<h", round(max(-32768.0, min(32767.0, share)))))
        return b"".join(parts)[:8]

    # Guards.

    def _guard(self) -> None:
        self.advance()
        now = self.bus.now()
        if self.motor_on and abs(self.speed()) > self.settings.speed_limit:
            self.fail("speed limit")
        seen, allowed = self._heartbeat_seen, self.objects.consumer_time
        if seen is not None and allowed and now - seen > allowed:
            self._heartbeat_seen = None
            self.fail("host heartbeat lost")
        if self.objects.producer_time and now >= self._next_heartbeat:
            self._next_heartbeat = now + self.objects.producer_time
            if not self.silent_heartbeat:
                state = next(n for n, name in canopen.STATES.items() if name == self.state)
                self._send(canopen.heartbeat_id(self.settings.node), bytes((state,)))
        self.bus.at(now + _PERIOD_OF_GUARDS, self._guard)

    def _send(self, identifier: int, payload: bytes) -> None:
        self.bus.transmit(
            can.Message(arbitration_id=identifier, data=payload, is_extended_id=False)
        )
