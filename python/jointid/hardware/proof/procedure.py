"""First motion: proof of a bench with a fraction of a degree and little more torque than breakaway."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

from jointid.base.argument_checks import require_kind
from jointid.base.errors import InputError
from jointid.hardware.bench.bench import Bench
from jointid.hardware.bench.opened_drive import open_drive
from jointid.hardware.proof.certified_limits import NO_SERIAL, has_serial
from jointid.hardware.proof.refusal import RefusedBenchError
from jointid.hardware.proof.result import FirstMotion
from jointid.hardware.proof.steps import Steps
from jointid.hardware.proof.watchdog import prove_watchdog, silence_of
from jointid.hardware.session.drive import Drive, DriveEnd, DriveFaultError
from jointid.hardware.session.interruptions import Interruptions
from jointid.hardware.session.realtime import RealTime
from jointid.hardware.session.watchdog import watchdog_of


def first_motion(
    bench: Bench,
    *,
    emulate: bool = False,
    seed: int = 0,
    drive: Drive | None = None,
    callback: Callable[[str], object] | None = None,
    watchdog: bool = False,
) -> FirstMotion:
    """Move a joint for the first time, and find signs, breakaway and scales in small motions.

    1. The joint rests with the motor off.
    2. The joint rests with the motor on at zero torque.
    3. In both directions, the torque grows from zero until the encoder counts.
    4. Short pushes just above the breakaway torque move the joint.
    5. A controller moves the joint slowly along small motions.

    Each step has its own condition to stop. The first error ends the procedure with the motor off.

    Parameters
    ----------
    bench : Bench
    emulate : bool
        Whether to use an emulated drive and joint in virtual time. Default False: the real drive and joint.
    seed : int
        Seed of the emulated noise. Default 0.
    drive : Drive, optional
        An open drive. The procedure closes this drive at its end. Default: the bench's drive.
    callback : callable, optional
        Function that is called with each line of the report.
    watchdog : bool
        Whether to test the drive's watchdog after all other steps. The motor is then on at zero torque, and the host
        stops sending. The drive must stop the motor as its `Watchdog` declares. Default False.

    Returns
    -------
    FirstMotion
        Result of the procedure. A refused bench is also a result and raises no exception.

    Raises
    ------
    InputError
        `bench` is not a Bench, its drive cannot be opened, or its watchdog cannot be tested.
    Exception
        A bug in the drive; the motor is switched off first.

    Examples
    --------
    >>> result = jid.hardware.first_motion(bench, emulate=True)
    >>> result.passed, result.reason
    (True, None)
    """
    require_kind("bench", bench, Bench)
    if drive is not None:
        return _moved(bench, drive, callback, watchdog)
    with open_drive(bench, emulate=emulate, seed=seed) as opened:
        if emulate:
            return _moved(bench, opened, callback, watchdog)
        with RealTime(bench.real_time):
            return _moved(bench, opened, callback, watchdog)


def _moved(
    bench: Bench, drive: Drive, callback: Callable[[str], object] | None, watchdog: bool
) -> FirstMotion:
    """Take the steps. The motor is off at the end in any case."""
    fall_silent = silence_of(drive) if watchdog else None
    steps = Steps(bench, drive, callback)
    reason, message = None, ""
    identity: dict[str, Any] = {}
    try:
        with Interruptions() as interruptions, _switched_off(drive) as ended:
            try:
                steps.run(interruptions)
                if fall_silent is not None:
                    prove_watchdog(steps, fall_silent, watchdog_of(drive), callback)
            except RefusedBenchError as refusal:
                reason, message = refusal.reason, str(refusal)
            except DriveFaultError as error:
                reason, message = error.kind, str(error)
            except InputError as error:
                if steps.axis is None:
                    raise
                reason, message = "error", str(error)
            except OSError as error:
                reason, message = "error", f"{type(error).__name__}: {error}"
            except KeyboardInterrupt:
                reason, message = "user", "interrupted from the keyboard"
            identity = drive.identity()
            if steps.axis is not None and not has_serial(identity):
                steps.unchecked.append(NO_SERIAL)
    finally:
        drive.close()
    (end,) = ended
    if end.motor_off is False and reason is None:
        reason, message = (
            "drive_fault",
            "the drive did not confirm at the end that the motor is off",
        )
    axis = steps.axis
    return FirstMotion(
        passed=reason is None,
        reason=reason,
        message=f"{message}; the drive reports: {end.failure}" if end.failure else message,
        travel=0.0 if axis is None else axis.travel,
        largest_torque=0.0 if axis is None else axis.largest_torque,
        duration=0.0 if axis is None else axis.now,
        signs=steps.signs,
        unchecked=tuple(steps.unchecked),
        motor_off=end.motor_off,
        identity=identity,
        drive_watchdog=watchdog_of(drive),
        steps=tuple(steps.lines),
        **steps.found,
    )


@contextmanager
def _switched_off(drive: Drive) -> Iterator[list[DriveEnd]]:
    """Switch the motor off at the end in any case, and report its state."""
    ended: list[DriveEnd] = []
    try:
        yield ended
    finally:
        ended.append(drive.disable() or DriveEnd())
