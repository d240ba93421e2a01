"""The motor of an emulated Elmo drive: its power stage, gear, joint and encoder."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from jointid.hardware.elmo.emulated_settings import ElmoSettings
from jointid.hardware.emulated.object_dictionary import WRONG_STATE, AccessError
from jointid.hardware.emulated.power_states import PowerStates

if TYPE_CHECKING:
    from jointid._core import SteppedJoint
    from jointid.hardware.emulated.device import DeviceBus

TWO_PI = 2.0 * math.pi
_WIDEST = 2**31  # largest absolute count that 32 bits hold


class ElmoMotor:
    """A motor and the joint that it moves, without the drive's bus and interpreters.

    Parameters
    ----------
    joint : SteppedJoint
        Joint that the motor moves.
    settings : ElmoSettings
    """

    def __init__(self, joint: SteppedJoint, settings: ElmoSettings) -> None:
        self.settings = settings
        self.joint = joint
        self.motor_on = False
        self.unit_mode = 5
        self.reference_mode = 1
        self.current = 0.0
        self.current_limits = [self.settings.peak_current, self.settings.continuous_current]
        self.speed_bounds: list[float | None] = [
            None,
            None,
        ]  # LL[2], HL[2]; None: from the settings
        self.modulo = list(self.settings.modulo)
        self.failure = 0
        self.problem = 0  # problem of the power stage, as in SR
        # Faults for tests; set them at a time with the bus's `at`.
        self.stuck_encoder: int | None = None
        self.count_offset = 0  # counts added since PX was set
        self.slipped_counts = 0
        self.fixed_unit_mode: int | None = None
        self.stage_gain = 1.0
        self.stuck_voltage: float | None = None
        self.silent_heartbeat = False
        # History for tests.
        self.torque_commands: list[tuple[float, float]] = []
        self.switchings: list[tuple[float, bool]] = []
        self._bus: DeviceBus | None = None
        self._time = 0.0
        self._held = False  # whether the brake holds the joint
        self.power = PowerStates(
            lambda: self.motor_on,
            lambda: bool(self.failure),
            self._switch_by_word,
            self.acknowledge,
        )

    @property
    def bus(self) -> DeviceBus:
        """Bus to which the drive is connected."""
        assert self._bus is not None, "attach the drive to a bus"
        return self._bus

    def advance(self) -> None:
        """Advance the joint to the bus's time."""
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
            # The brake holds a joint that has stopped and is not pushed back.
            self._held = before * self.joint.velocity <= 0.0

    def counts(self) -> int:
        """Return the encoder counts of the motor. They wrap as the drive's do; a stuck encoder repeats them."""
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
        """Return the speed of the motor [counts/s]."""
        if self._held:
            return 0
        per_radian = self.settings.counts_per_turn * self.settings.gear_ratio / TWO_PI
        return max(-_WIDEST, min(_WIDEST - 1, round(self.joint.velocity * per_radian)))

    def voltage(self) -> float:
        """Return the voltage at the analog input [V]."""
        if self.stuck_voltage is not None:
            return self.stuck_voltage
        reading = self.joint.observe().reading
        return self.settings.analog.voltage(reading, self.joint.position)

    def status(self) -> int:
        """Return the status register SR."""
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
        """Current that scales 6077h [A]."""
        rated = self.settings.rated_current
        return self.current_limits[1] if rated is None else rated

    @property
    def rated_torque(self) -> float:
        """Motor torque at the rated current [N·m]."""
        return self.rated_current * abs(self.settings.torque_constant)

    def share_of_rated(self) -> int:
        """Return the current in thousandths of the rated current; 0 if the rated current is 0."""
        if not self.rated_current:
            return 0
        share = 1000.0 * self.current / self.rated_current
        return round(max(-32768.0, min(32767.0, share)))

    @property
    def current_limited(self) -> bool:
        """Whether the current is above the continuous limit."""
        return abs(self.current) > self.current_limits[1]

    def command_current(self, current: float) -> None:
        """Set the current [A], limited as the power stage limits it."""
        self.current = self.stage_gain * current
        self.torque_commands.append((self.bus.now(), self.current))

    def limit_current(self) -> None:
        """Reduce the present current after PL[1] is set below it."""
        peak = self.current_limits[0]
        if abs(self.current) > peak:
            self.current = math.copysign(peak, self.current)
            self.torque_commands.append((self.bus.now(), self.current))

    def switch(self, *, on: bool) -> None:
        """Switch the motor on or off, at zero current."""
        if on != self.motor_on:
            self.switchings.append((self.bus.now(), on))
        self.motor_on, self.current = on, 0.0
        if on:
            self.acknowledge()

    def acknowledge(self) -> None:
        """Clear the failure that switched the motor off."""
        self.failure = 0

    def _switch_by_word(self, on: bool) -> None:
        if on and self.problem:
            raise AccessError(WRONG_STATE)
        self.switch(on=on)
