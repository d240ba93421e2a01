"""Test of the drive's own watchdog by a silent host, without pulling a plug."""

from __future__ import annotations

from collections.abc import Callable
from typing import cast

from jointid.base.errors import InputError
from jointid.hardware.proof.refusal import RefusedBenchError
from jointid.hardware.proof.steps import Steps
from jointid.hardware.session.drive import Drive
from jointid.hardware.session.silence import DriveSilence
from jointid.hardware.session.watchdog import Watchdog

_BEATEN = 1.0  # [s] at zero torque, in which a drive starts its watchdog
_LATE = 3.0  # times the allowed time; the drive is asked after twice that, and the host may be late


def silence_of(drive: Drive) -> Callable[[], DriveSilence]:
    """Return a drive's method `fall_silent`.

    Raises
    ------
    InputError
        The drive has no such method.
    """
    method = getattr(drive, "fall_silent", None)
    if not callable(method):
        raise InputError(
            "this drive has no method fall_silent, so its watchdog cannot be tested",
            argument="watchdog",
            remedy="leave this option out, and instead pull the plug once",
        )
    return cast("Callable[[], DriveSilence]", method)


def prove_watchdog(
    steps: Steps,
    fall_silent: Callable[[], DriveSilence],
    declared: Watchdog | None,
    callback: Callable[[str], object] | None = None,
) -> None:
    """Check that the drive stops its motor as declared (default: off), and keep the time.

    The torque is zero, so that a drive that does not react moves nothing. Afterwards the motor is switched on once
    more, which clears the failure in the drive. A session would not start with it.

    Parameters
    ----------
    steps : Steps
        Passed steps, with the motor on. The test adds to `found`, `unchecked` and `lines`.
    fall_silent : callable
        Method `fall_silent` of the drive.
    declared : Watchdog or None
        Watchdog that the drive declares.
    callback : callable, optional
        Called with the line of the report.

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
    wanted = "off" if declared is None else declared.then
    after = _judged(silence, wanted)
    steps.found["watchdog"] = after
    steps.unchecked.remove("watchdog")
    line = f"watchdog: the motor was {wanted} {'' if silence.told is not None else 'at most '}{1e3 * after:.1f} ms "
    line += f"after the host's last sign of life; {1e3 * silence.allowed:g} ms is allowed"
    steps.lines.append(line)
    if callback is not None:
        callback(line)
    axis.enable()


def _judged(silence: DriveSilence, wanted: str) -> float:
    """Return the time until the motor was in the required state [s]."""
    allowed = f"{1e3 * silence.allowed:g} ms without a sign of the host"
    if silence.state is None:
        raise RefusedBenchError("watchdog", f"the drive does not answer after {allowed}")
    if silence.state != wanted:
        still = "still on" if silence.state == "on" else silence.state
        raise RefusedBenchError(
            "watchdog",
            f"the motor is {still} after {1e3 * silence.asked:.0f} ms without a sign of the host; the drive was set "
            f"to be {wanted} after {allowed}. The motor would go on if this program died or the cable was pulled",
        )
    if not silence.missed_host:
        raise RefusedBenchError(
            "watchdog",
            f"the motor was {wanted} after {allowed}, but for another reason: "
            f"{silence.failure or 'the drive states no reason'}",
        )
    after = silence.asked if silence.told is None else silence.told
    if after > _LATE * silence.allowed:
        raise RefusedBenchError(
            "watchdog",
            f"the motor was {wanted} only {1e3 * after:.0f} ms after the host's last sign of life; "
            f"{1e3 * silence.allowed:g} ms is allowed",
        )
    return after
