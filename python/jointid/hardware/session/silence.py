"""What a drive did when its host fell silent on purpose."""

from __future__ import annotations

from dataclasses import dataclass

from jointid.hardware.session.motor_state import MotorState, is_off, state_of


@dataclass(frozen=True, slots=True, kw_only=True, init=False)
class DriveSilence:
    """What a drive did when nothing was sent to it, its motor on at no torque.

    Returned by a drive's method `fall_silent`, which sends nothing for twice the time that its watchdog takes,
    and then asks the drive.

    Attributes
    ----------
    allowed : float
        Time that the drive was told to wait for the host [s].
    state : {"off", "damped", "held", "braked", "on"} or None
        What it says of its motor; None: it does not answer.
    told : float or None
        From the host's last sign of life until the drive reported that it is missing [s]; None: it did not.
    asked : float
        From then until it was asked [s].
    missed_host : bool
        It names the missing host as the reason.
    failure : str
        What it names. Default: nothing.
    motor_off : bool or None
        Whether `state` is "off"; as an argument the older name of it, True for "off" and False for "on".
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
        """Whether it says that its motor is off; None: it does not answer."""
        return is_off(self.state)
