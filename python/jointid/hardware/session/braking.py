"""Controlled braking: torque against the motion before the motor goes off."""

from __future__ import annotations

from dataclasses import dataclass

from jointid.hardware.session.drive import Drive, DriveFaultError, DriveSample
from jointid.hardware.session.limits import SessionLimits
from jointid.hardware.session.moving_joint import MovingJoint
from jointid.hardware.session.options import SessionOptions
from jointid.hardware.session.stop import LimitError

BRAKED = frozenset(
    {
        *("position", "velocity", "tracking_error", "torque", "torque_rate", "torque_envelope"),
        *("saturated_samples", "late_share", "user"),
    }
)
"""Stops behind which the joint is braked: its position is known, and the drive has done what it was told."""

_AT_REST = 0.02  # [rad/s]
_LONGEST = 2.0  # times as long as it should take
_SHORTEST = 0.05  # [s]
_TRIED = 5  # cycles, after which the joint must be slower
_LOST = 3  # samples in a row
_CREDIBLE = 1.5  # of the velocity limit


@dataclass(frozen=True, slots=True, kw_only=True)
class Braked:
    """How a joint was braked.

    Attributes
    ----------
    velocity, left : float
        Speed before and after [rad/s].
    time, travel : float
        That it took [s], [rad].
    """

    velocity: float
    left: float
    time: float
    travel: float


def brake_after(
    cause: BaseException,
    drive: Drive,
    joint: MovingJoint | None,
    limits: SessionLimits,
    options: SessionOptions,
    sample: DriveSample | None,
) -> Braked | None:
    """Brake behind a stop that allows it; None where it does not, or the joint's inertia is not known.

    Raises
    ------
    DriveFaultError
        The drive fails.
    """
    if joint is None or sample is None:
        return None
    if not isinstance(cause, LimitError) or cause.limit not in BRAKED:
        return None
    return brake(*(drive, joint, limits, sample), period=options.period, timeout=options.timeout)


def brake(
    drive: Drive,
    joint: MovingJoint,
    limits: SessionLimits,
    sample: DriveSample,
    *,
    period: float,
    timeout: float,
) -> Braked | None:
    """Brake a joint until it hardly moves; the motor is still on behind this.

    It ends early, at the last torque, when the joint does not become slower, reverses, or cannot be seen.

    Parameters
    ----------
    drive : Drive
    joint : MovingJoint
    limits : SessionLimits
        Torque and velocity: a joint that seems much faster is not braked, because its encoder is not believed.
    sample : DriveSample
        The last one.
    period, timeout : float
        Of the cycles, and for an answer [s].

    Returns
    -------
    Braked or None
        None: it cannot be told how to brake, or the joint cannot be seen.

    Raises
    ------
    DriveFaultError
        The drive fails; nothing is left but to switch the motor off.
    """
    braking = joint.braking(limits.torque)
    if braking is None:
        return None
    most, deceleration = braking
    clock = drive.clock
    begin, first, last = clock.now(), sample, sample
    before: float | None = None  # the speed at the beginning, in the direction of the motion
    speed, direction, lost, end = 0.0, 0.0, 0, begin + _SHORTEST
    cycle = 0
    while clock.now() < end:
        cycle += 1
        clock.sleep_until(begin + cycle * period)
        try:
            sample = drive.read(timeout)
        except DriveFaultError as error:
            lost += 1
            if error.kind != "stale_position" or lost > _LOST:
                raise
            continue
        lost = 0
        if not sample.time > last.time:
            break
        velocity = (sample.position - last.position) / (sample.time - last.time)
        last = sample
        if abs(velocity) > _CREDIBLE * limits.velocity:
            break
        if before is None:
            before, direction = abs(velocity), 1.0 if velocity > 0.0 else -1.0
            end = clock.now() + max(_SHORTEST, _LONGEST * before / deceleration)
        speed = direction * velocity
        if speed < _AT_REST or (cycle > _TRIED and speed > before):
            break
        # Softer at the end: within two cycles it would turn round.
        drive.command(-direction * min(most, joint.inertia * speed / (2.0 * period)))
    if before is None:
        return None
    return Braked(
        velocity=before,
        left=speed,
        time=clock.now() - begin,
        travel=last.position - first.position,
    )
