"""An emulated Elmo SimplIQ drive: the same frames, limits and refusals, moving a simulated joint."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from jointid.hardware.can import canopen_frames as canopen
from jointid.hardware.elmo.emulated_interpreter import Interpreter
from jointid.hardware.elmo.emulated_network import MOTOR_EVENT, ElmoNetwork
from jointid.hardware.elmo.emulated_objects import ElmoObjects
from jointid.hardware.elmo.emulated_settings import ElmoSettings
from jointid.hardware.emulated.faults import drive_failure, error_register
from jointid.hardware.emulated.object_dictionary import WRONG_STATE, AccessError
from jointid.hardware.emulated.power_states import PowerStates

if TYPE_CHECKING:
    import can

    from jointid._core import SteppedJoint
    from jointid.hardware.emulated.device import DeviceBus

__all__ = ["ElmoSettings", "EmulatedElmo"]

TWO_PI = 2.0 * math.pi
_HEARTBEAT_LOST = 0x800  # in MF
_WIDEST = 2**31  # counts that 32 bits hold, each way
_PERIOD_OF_GUARDS = 0.5e-3  # [s] between looks at speed and heartbeat


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
        self.motor_on = False
        self.unit_mode = 5
        self.reference_mode = 1
        self.current = 0.0
        self.current_limits = [self.settings.peak_current, self.settings.continuous_current]
        self.speed_bounds: list[float | None] = [
            None,
            None,
        ]  # LL[2], HL[2]; None: as in the settings
        self.modulo = list(self.settings.modulo)
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
        self._time = 0.0
        self._held = False  # by the brake
        self.power = PowerStates(
            lambda: self.motor_on,
            lambda: bool(self.failure),
            self._switch_by_word,
            self.acknowledge,
        )
        self.objects = ElmoObjects(self)
        self._network = ElmoNetwork(self, self._reset)
        self._interpreter = Interpreter(self)

    @property
    def bus(self) -> DeviceBus:
        """The bus to which it is connected."""
        assert self._bus is not None, "attach the drive to a bus"
        return self._bus

    @property
    def state(self) -> str:
        """Of the network: "pre-operational", "operational" or "stopped"."""
        return self._network.state

    @state.setter
    def state(self, state: str) -> None:
        self._network.state = state

    def attach(self, bus: DeviceBus) -> None:
        """Power up: a boot-up message, then guards look at speed and heartbeat."""
        self._bus = bus
        self._network.boot()
        bus.at(bus.now() + _PERIOD_OF_GUARDS, self._guard)

    def receive(self, message: can.Message) -> None:
        """A frame has arrived."""
        self.advance()
        self._network.receive(message)

    @property
    def interpreter(self) -> Interpreter:
        """Of its commands, binary and of text."""
        return self._interpreter

    def interpret(self, payload: bytes) -> None:
        """Take a command of the binary interpreter's."""
        self._interpreter.take(payload)

    def advance(self) -> None:
        """Bring the joint to the bus's time."""
        now = self.bus.now()
        duration = now - self._time
        if duration <= 0.0:
            return
        self._time = now
        if self.motor_on or not self.settings.brake:
            torque = self.current if self.motor_on else 0.0
            torque *= self.settings.torque_constant * self.settings.gear_ratio
            self.joint.advance(torque, duration)
            self._held = False
        elif not self._held:
            before = self.joint.velocity
            if before:
                self.joint.advance(-math.copysign(self.settings.brake, before), duration)
            self._held = before * self.joint.velocity <= 0.0  # it stands, and is not pushed back

    def counts(self) -> int:
        """Encoder counts of the motor; an encoder that hangs repeats them. They wrap as the drive's do."""
        if self.stuck_encoder is not None:
            return self.stuck_encoder
        angle = self.joint.position - self.settings.position_offset
        per_turn = self.settings.counts_per_turn * self.settings.gear_ratio
        found = math.floor(angle / TWO_PI * per_turn) + self.slipped_counts + self.count_offset
        lowest, highest = self.modulo
        if highest <= lowest:
            lowest, highest = -_WIDEST, _WIDEST
        return (found - lowest) % (highest - lowest) + lowest

    def speed(self) -> int:
        """Of the motor [counts/s]."""
        if self._held:
            return 0
        per_radian = self.settings.counts_per_turn * self.settings.gear_ratio / TWO_PI
        return max(-_WIDEST, min(_WIDEST - 1, round(self.joint.velocity * per_radian)))

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
            | 0x2000 * self.current_limited
        )

    @property
    def rated_current(self) -> float:
        """By which 6077h is scaled [A]."""
        rated = self.settings.rated_current
        return self.current_limits[1] if rated is None else rated

    @property
    def rated_torque(self) -> float:
        """Of the motor at its rated current [N·m]."""
        return self.rated_current * abs(self.settings.torque_constant)

    def share_of_rated(self) -> int:
        """The current in thousandths of the rated one; 0 where that is 0."""
        if not self.rated_current:
            return 0
        share = 1000.0 * self.current / self.rated_current
        return round(max(-32768.0, min(32767.0, share)))

    @property
    def current_limited(self) -> bool:
        """Whether the current is more than the drive gives for long."""
        return abs(self.current) > self.current_limits[1]

    def command_current(self, current: float) -> None:
        """Let a current flow [A], as the power stage does it."""
        self.current = self.stage_gain * current
        self.torque_commands.append((self.bus.now(), self.current))

    def limit_current(self) -> None:
        """Cut the current that flows, when PL[1] is set below it."""
        peak = self.current_limits[0]
        if abs(self.current) > peak:
            self.current = math.copysign(peak, self.current)
            self.torque_commands.append((self.bus.now(), self.current))

    def switch(self, *, on: bool) -> None:
        """Motor on or off, at no current."""
        if on != self.motor_on:
            self.switchings.append((self.bus.now(), on))
        self.motor_on, self.current = on, 0.0
        if on:
            self.acknowledge()

    def acknowledge(self) -> None:
        """Clear what the motor was shut down for, and say that it is gone."""
        self.failure = 0
        self._network.emergencies.vanish()

    def fail(self, kind: str) -> None:
        """Shut the motor down, with a failure in MF and, where 2F21h asks for it, an emergency.

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
        told = self.objects.emergency_wanted(MOTOR_EVENT)
        self._network.emergencies.appear(emergency, error_register(emergency), told=told)

    def lose_host(self) -> None:
        """The host's heartbeat has stayed away: do with the motor what 6007h says."""
        if self.objects.value(0x6007, 0):
            self.advance()
            self.switch(on=False)
            self.failure = _HEARTBEAT_LOST

    def abort_connection(self) -> None:
        """The node is stopped or reset: do with the motor what 6007h says (CiA 402)."""
        option = self.objects.value(0x6007, 0)
        if option and self.motor_on:
            self.switch(on=False)
            if option == 1:
                self.failure = _HEARTBEAT_LOST

    def restart(self) -> None:
        """As if its supply had failed for a moment."""
        self.advance()
        self.failure = self.problem = 0
        self._network.command(canopen.RESET_NODE)

    def reply(self, payload: bytes) -> None:
        """Publish a result of the interpreter's."""
        self._network.reply(payload)

    def _reset(self, application: bool) -> None:
        self.objects.reset()
        self._interpreter.forget()
        if application:
            self.switch(on=False)
            self.power.forget()
            self.unit_mode = 5

    def _switch_by_word(self, on: bool) -> None:
        if on and self.problem:
            raise AccessError(WRONG_STATE)
        self.switch(on=on)

    def _guard(self) -> None:
        self.advance()
        now = self.bus.now()
        low, high = self.speed_bounds
        limit = self.settings.speed_limit
        least, most = -limit if low is None else low, limit if high is None else high
        if self.motor_on and not least <= self.speed() <= most:
            self.fail("speed limit")
        self._network.look(now)
        self.bus.at(now + _PERIOD_OF_GUARDS, self._guard)
