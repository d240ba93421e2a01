"""What a drive did when its host fell silent on purpose."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class DriveSilence:
    """What a drive did when nothing was sent to it, its motor on at no torque.

    Returned by a drive's method `fall_silent`, which sends nothing for twice the time that its watchdog takes,
    and then asks the drive.

    Attributes
    ----------
    allowed : float
        Time that the drive was told to wait for the host [s].
    motor_off : bool or None
        Whether it says that its motor is off; None: it does not answer.
    told : float or None
        From the host's last sign of life until the drive reported that it is missing [s]; None: it did not.
    asked : float
        From then until it was asked [s].
    missed_host : bool
        It names the missing host as the reason.
    failure : str
        What it names. Default: nothing.
    """

    allowed: float
    motor_off: bool | None
    told: float | None
    asked: float
    missed_host: bool
    failure: str = ""
