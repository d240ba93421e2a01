"""The drive's own watchdog, tried without a plug: the host falls silent, and the motor must go off by itself."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, cast

from jointid.base.errors import InputError
from jointid.hardware.proof.refusal import RefusedBenchError
from jointid.hardware.session.drive import Drive
from jointid.hardware.session.silence import DriveSilence

if TYPE_CHECKING:
    from jointid.hardware.proof.steps import Steps

_BEATEN = 1.0  # [s] at no torque: a drive that only begins to watch has begun by then
_LATE = 3.0  # times the time allowed: the drive is asked after twice that, and the host may be late


def silence_of(drive: Drive) -> Callable[[], DriveSilence]:
    """Return a drive's method `fall_silent`.

    Raises
    ------
    InputError
        It has none.
    """
    method = getattr(drive, "fall_silent", None)
    if not callable(method):
        raise InputError(
            "this drive has no method fall_silent, so its watchdog cannot be tried",
            argument="watchdog",
            remedy="leave the option out, and pull the plug once",
        )
    return cast("Callable[[], DriveSilence]", method)


def prove_watchdog(
    steps: Steps,
    fall_silent: Callable[[], DriveSilence],
    callback: Callable[[str], object] | None = None,
) -> None:
    """See that the drive switches its motor off by itself, and enter when.

    The joint stands at no torque, so that a drive which goes on moves nothing. Afterwards the motor is switched
    on once more, which takes the failure out of the drive: a session would not start with it.

    Parameters
    ----------
    steps : Steps
        That have passed, the motor on; `found`, `unchecked` and `lines` are added to.
    fall_silent : callable
        Of the drive.
    callback : callable, optional
        Called with the line.

    Raises
    ------
    RefusedBenchError
        "watchdog": the motor is still on, or went off late or for another reason.
    DriveFaultError
    """
    axis = steps.axis
    assert axis is not None
    axis.rest()
    end = axis.now + _BEATEN
    while axis.now < end:
        axis.read()
        axis.command(0.0)
    silence = fall_silent()
    after = _judged(silence)
    steps.found["watchdog"] = after
    steps.unchecked.remove("watchdog")
    line = f"watchdog: motor off by itself {'' if silence.told is not None else 'at most '}{1e3 * after:.1f} ms "
    line += f"after the last heartbeat; allowed are {1e3 * silence.allowed:g} ms"
    steps.lines.append(line)
    if callback is not None:
        callback(line)
    axis.enable()


def _judged(silence: DriveSilence) -> float:
    """After how long the motor went off [s]."""
    allowed = f"{1e3 * silence.allowed:g} ms without a sign of the host"
    if silence.motor_off is None:
        raise RefusedBenchError("watchdog", f"the drive does not answer after {allowed}")
    if not silence.motor_off:
        raise RefusedBenchError(
            "watchdog",
            f"the motor is still on after {1e3 * silence.asked:.0f} ms without a heartbeat; the drive was told to "
            f"switch it off after {allowed}. It would go on when this program has died or the cable is pulled",
        )
    if not silence.missed_host:
        raise RefusedBenchError(
            "watchdog",
            f"the motor went off after {allowed}, but for another reason: {silence.failure or 'none is named'}",
        )
    after = silence.asked if silence.told is None else silence.told
    if after > _LATE * silence.allowed:
        raise RefusedBenchError(
            "watchdog",
            f"the motor went off only {1e3 * after:.0f} ms after the last heartbeat; allowed are "
            f"{1e3 * silence.allowed:g} ms",
        )
    return after
