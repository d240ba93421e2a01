"""Reaction of a drive when its host is silent on purpose."""

from __future__ import annotations

from dataclasses import dataclass

from jointid.hardware.session.motor_state import MotorState, is_off, state_of


@dataclass(frozen=True, slots=True, kw_only=True, init=False)
class DriveSilence:
    """Reaction of a drive to a silent host, its motor on at zero torque.

    The drive's method `fall_silent` returns it. The method sends nothing for twice the watchdog's time, and then
    asks the drive.

    Attributes
    ----------
    allowed : float
        Watchdog time set in the drive [s].
    state : {"off", "damped", "held", "braked", "on"} or None
        State of the motor that the drive reports; None if it does not answer.
    told : float or None
        Time from the host's last sign of life until the drive reported the missing host [s]; None if it did not.
    asked : float
        Time from then until the drive was asked [s].
    missed_host : bool
        Whether the drive names the missing host as the reason.
    failure : str
        Reason that the drive names. Default: none.
    motor_off : bool or None
        Whether `state` is "off". As an argument, the former name of `state`: True is "off", False is "on".
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
        """Whether the drive reports that its motor is off; None if it does not answer."""
        return is_off(self.state)
