"""Reaction of a drive when its host is silent on purpose."""

from __future__ import annotations

from dataclasses import dataclass

from jointid.hardware.session.motor_state import MotorState, is_off, state_of


@dataclass(frozen=True, slots=True, kw_only=True, init=False)
class DriveSilence:
    """Reaction of a drive to a silent host, with the motor on at zero torque.

    The drive's method `fall_silent` returns this object. The method sends nothing for twice the watchdog time, and
    then requests the drive's state.

    Attributes
    ----------
    allowed : float
        Watchdog time set in the drive [s].
    state : {"off", "damped", "held", "braked", "on"} or None
        State of the motor that the drive reports; None if the drive does not answer.
    told : float or None
        Time from the host's last sign of life until the drive reported the missing host [s]; None without such a
        report.
    asked : float
        Time from the host's last sign of life until the drive's state was requested [s].
    missed_host : bool
        Whether the drive reports the missing host as the reason of its reaction.
    failure : str
        Reason that the drive reports. Default: empty.
    motor_off : bool or None
        Whether `state` is "off". As an argument, `motor_off` is the former name of `state`: True means "off", False
        means "on".
    """

    allowed: float
    state: MotorState | None
    told: float | None
    asked: float
    missed_host: bool
    failure: str

    def __init__(
        self,
        *,
        allowed: float,
        told: float | None,
        asked: float,
        missed_host: bool,
        state: MotorState | None = None,
        failure: str = "",
        motor_off: bool | None = None,
    ) -> None:
        known = {"allowed": allowed, "told": told, "asked": asked, "missed_host": missed_host}
        given = {**known, "state": state_of(state, motor_off), "failure": failure}
        for name, value in given.items():
            object.__setattr__(self, name, value)

    @property
    def motor_off(self) -> bool | None:
        """Whether the drive reports that its motor is off; None if the drive does not answer."""
        return is_off(self.state)
