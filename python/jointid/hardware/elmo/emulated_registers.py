"""The commands of an emulated Elmo drive's interpreters: values they read and set, and refusals.

Source: Elmo's SimplIQ command reference (MAN-SIMCR). Parameters that a session does not need, e.g. a
profile's acceleration, are stored and have no effect.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass

from jointid.hardware.elmo.emulated_motor import ElmoMotor

Number = int | float
Read = Callable[[int], Number]
Write = Callable[[int, Number], int]  # returns EC, 0 without an error

# EC.
BAD_COMMAND, BAD_INDEX, NO_MEANING = 2, 3, 5
OUT_OF_RANGE, NOT_ASSIGNED, MOTOR_MUST_BE_OFF, MOTOR_MUST_BE_ON = 21, 23, 57, 58
BAD_UNIT_MODE, NOT_READY = 60, 66

_TORQUE = 1  # UM
_CURRENT_TOLERANCE = 1e-6  # [A]
_SAMPLING = 90  # TS [µs]
_WIDEST = 2**31


@dataclass(frozen=True, slots=True, kw_only=True)
class Register:
    """One command of the drive.

    Attributes
    ----------
    read : callable
        Returns the value at an index. A command that acts is executed and returns 0.
    write : callable, optional
        Assigns a value at an index and returns EC. Default: it cannot be assigned.
    indices : tuple of int
    """

    read: Read
    write: Write | None = None
    indices: tuple[int, ...] = (0,)


def registers(
    motor: ElmoMotor, identity: Callable[[int], int], last_error: Callable[[], int]
) -> dict[str, Register]:
    """Return a drive's commands by their letters.

    Parameters
    ----------
    motor : ElmoMotor
    identity : callable
        Returns an entry of 1018h: vendor, product, revision or serial number, for 1 to 4.
    last_error : callable
        Returns EC of the last refused command.
    """
    kept = _Kept(motor)
    limits = _Limits(motor)
    found = {
        "MO": Register(read=lambda _: int(motor.motor_on), write=_motor(motor)),
        "SO": Register(read=lambda _: int(motor.motor_on)),
        "UM": Register(read=lambda _: motor.unit_mode, write=_unit_mode(motor)),
        "RM": Register(read=lambda _: motor.reference_mode, write=_reference_mode(motor)),
        "TC": Register(read=lambda _: float(motor.current), write=_torque(motor)),
        "PX": Register(read=lambda _: motor.counts(), write=_position(motor)),
        "PU": Register(read=lambda _: motor.counts()),
        "VX": Register(read=lambda _: motor.speed()),
        "IQ": Register(read=lambda _: float(motor.current)),
        "ID": Register(read=lambda _: 0.0),
        "SR": Register(read=lambda _: motor.status()),
        "MF": Register(read=lambda _: motor.failure),
        "EC": Register(read=lambda _: last_error()),
        "MS": Register(read=lambda _: 0),
        "LC": Register(read=lambda _: int(motor.current_limited)),
        "PL": Register(read=limits.peak, write=limits.set_peak, indices=(1, 2)),
        "CL": Register(read=limits.continuous, write=limits.set_continuous, indices=(1, 2, 3)),
        "MC": Register(read=lambda _: limits.largest),
        "SN": Register(read=lambda index: _wrapped(identity(index)), indices=(1, 2, 3, 4)),
        "AN": Register(read=lambda index: _analog(motor, index), indices=tuple(range(1, 7))),
        "TI": Register(read=lambda _: round(motor.settings.temperature), indices=(1, 2)),
        "BV": Register(read=lambda _: 100),  # [V], highest supply voltage
        "IP": Register(read=lambda _: 0),
        "IB": Register(read=lambda _: 0, indices=tuple(range(1, 11))),
        "TS": Register(read=lambda _: _SAMPLING),
        "TM": Register(read=lambda _: _wrapped(round(1e6 * motor.bus.now())), write=lambda *_: 0),
        "ST": Register(read=lambda _: _stop(motor)),
        "BG": Register(read=lambda _: 0),
        "HP": Register(read=lambda _: 0),
    }
    found |= kept.registers()
    return found


class _Limits:
    """PL and CL, the limits that affect the drive."""

    def __init__(self, motor: ElmoMotor) -> None:
        self._motor = motor
        self.largest = 2.0 * max(motor.settings.peak_current, motor.settings.continuous_current)
        self._more: dict[tuple[str, int], float] = {("PL", 2): 3.0, ("CL", 2): 0.0, ("CL", 3): 0.0}

    def peak(self, index: int) -> float:
        return float(self._motor.current_limits[0] if index == 1 else self._more["PL", index])

    def continuous(self, index: int) -> float:
        return float(self._motor.current_limits[1] if index == 1 else self._more["CL", index])

    def set_peak(self, index: int, value: Number) -> int:
        if index == 1:
            if not 0.0 <= value <= self.largest:
                return OUT_OF_RANGE
            self._motor.current_limits[0] = float(value)
            self._motor.limit_current()
        else:
            self._more["PL", index] = float(value)
        return 0

    def set_continuous(self, index: int, value: Number) -> int:
        if index == 1:
            if not 0.0 <= value <= self.largest:
                return OUT_OF_RANGE
            self._motor.current_limits[1] = float(value)
        else:
            self._more["CL", index] = float(value)
        return 0


class _Kept:
    """Parameters that are only stored. Those of the encoder can be set only with the motor off."""

    def __init__(self, motor: ElmoMotor) -> None:
        self._motor = motor
        settings = motor.settings
        self._values: dict[tuple[str, int], Number] = {
            **{("CA", index): 0 for index in range(1, 29)},
            ("CA", 18): abs(settings.counts_per_turn),
            ("CA", 19): 1,  # pairs of poles
            ("ER", 2): 10**9,
            ("ER", 3): 10**9,
            ("HL", 3): 10**9,
            ("LL", 3): -(10**9),
            **{(letters, 0): 0 for letters in ("JV", "SF")},
            **{(letters, 0): 10**6 for letters in ("AC", "DC", "SD")},
        }

    def registers(self) -> dict[str, Register]:
        found = {}
        for letters in sorted({letters for letters, _ in self._values}):
            indices = tuple(index for name, index in self._values if name == letters)
            found[letters] = self._register(letters, indices)
        found["HL"] = self._speed_bound("HL", 1.0)
        found["LL"] = self._speed_bound("LL", -1.0)
        motor = self._motor
        found["XM"] = Register(
            read=lambda index: motor.modulo[index - 1], write=self._set_modulo, indices=(1, 2)
        )
        return found

    def _register(self, letters: str, indices: Iterable[int]) -> Register:
        def write(index: int, value: Number) -> int:
            if letters == "CA" and self._motor.motor_on:
                return MOTOR_MUST_BE_OFF
            self._values[letters, index] = type(self._values[letters, index])(value)
            return 0

        return Register(
            read=lambda index: self._values[letters, index], write=write, indices=tuple(indices)
        )

    def _speed_bound(self, letters: str, sign: float) -> Register:
        """Return HL[2] or LL[2], the speed limits at which the drive switches off. [3] are position limits."""
        motor = self._motor

        def read(index: int) -> Number:
            if index == 2:
                bound = motor.speed_bounds[letters == "HL"]
                return int(sign * motor.settings.speed_limit if bound is None else bound)
            return self._values[letters, index]

        def write(index: int, value: Number) -> int:
            if sign * value < 0:
                return OUT_OF_RANGE
            if index == 2:
                motor.speed_bounds[letters == "HL"] = float(value)
            else:
                self._values[letters, index] = int(value)
            return 0

        return Register(read=read, write=write, indices=(2, 3))

    def _set_modulo(self, index: int, value: Number) -> int:
        if self._motor.motor_on:
            return MOTOR_MUST_BE_OFF
        self._motor.modulo[index - 1] = int(value)
        return 0


def _motor(motor: ElmoMotor) -> Write:
    def write(_: int, value: Number) -> int:
        if value not in (0, 1):
            return OUT_OF_RANGE
        if value and motor.problem:
            return NOT_READY
        motor.switch(on=bool(value))
        return 0

    return write


def _unit_mode(motor: ElmoMotor) -> Write:
    def write(_: int, value: Number) -> int:
        if motor.motor_on:
            return MOTOR_MUST_BE_OFF
        if value not in (1, 2, 3, 4, 5):
            return OUT_OF_RANGE
        if motor.fixed_unit_mode is None:
            motor.unit_mode = int(value)
        return 0

    return write


def _reference_mode(motor: ElmoMotor) -> Write:
    def write(_: int, value: Number) -> int:
        if value not in (0, 1):
            return OUT_OF_RANGE
        motor.reference_mode = int(value)
        return 0

    return write


def _torque(motor: ElmoMotor) -> Write:
    def write(_: int, value: Number) -> int:
        if not motor.motor_on:
            return MOTOR_MUST_BE_ON
        if motor.unit_mode != _TORQUE:
            return BAD_UNIT_MODE
        if abs(value) > motor.current_limits[0] + _CURRENT_TOLERANCE:
            return OUT_OF_RANGE
        motor.command_current(_quantised(float(value), motor.settings.mantissa_bits))
        return 0

    return write


def _position(motor: ElmoMotor) -> Write:
    def write(_: int, value: Number) -> int:
        if motor.motor_on:
            return MOTOR_MUST_BE_OFF
        motor.count_offset += int(value) - motor.counts()
        return 0

    return write


def _stop(motor: ElmoMotor) -> int:
    motor.current = 0.0
    return 0


def _analog(motor: ElmoMotor, index: int) -> float:
    """Return inputs 1 and 2 [V], the currents of two phases [A] or the supply voltage [V]."""
    share = {3: 1.0, 4: -1.0, 5: 0.0}
    if index == 6:
        return motor.settings.supply
    return motor.voltage() if index < 3 else share[index] * motor.current


def _quantised(current: float, bits: int) -> float:
    if bits >= 24 or current == 0.0:
        return current
    mantissa, exponent = math.frexp(current)
    return math.ldexp(math.trunc(mantissa * 2**bits) / 2**bits, exponent)


def _wrapped(number: int) -> int:
    return (number + _WIDEST) % (2 * _WIDEST) - _WIDEST
