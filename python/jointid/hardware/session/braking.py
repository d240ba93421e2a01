"""Controlled braking: torque against the motion before the motor goes off."""

from __future__ import annotations

from dataclasses import dataclass

from jointid.hardware.session.control_loop import Follower
from jointid.hardware.session.drive import Drive, DriveFaultError, DriveSample
from jointid.hardware.session.limits import SessionLimits
from jointid.hardware.session.moving_joint import MovingJoint
from jointid.hardware.session.options import SessionOptions
from jointid.hardware.session.stop import LimitError

BRAKED = frozenset(
    {
        *("position", "velocity", "tracking_error", "torque", "torque_rate", "torque_envelope"),
        *("saturated_samples", "late_samples", "late_share", "user"),
    }
)
"""Stops behind which the joint is braked: its position is known, and the drive has done what it was told."""

_AT_REST = 0.02  # [rad/s]
_LONGEST = 2.0  # times as long as it should take; beyond, only while the joint becomes slower
_BOUND = 20.0  # times as long as it should take, in any case
_SHORTEST = 0.05  # [s]
_SLOWER = 0.05  # of the deceleration that it should have
_MUCH_SLOWER = 0.2  # of the speed, within _SHORTEST
_LOST = 5  # samples in a row, at least; the torque meanwhile is that of a joint that becomes slower
_TRIED = 5  # cycles, after which the joint must be slower
_CREDIBLE = 1.5  # of the velocity limit


@dataclass(frozen=True, slots=True, kw_only=True)
class Braked:
    """How a joint was braked.

    Attributes
    ----------
    velocity, left : float
        Speed before and after [rad/s]; believed where no sample came.
    time, travel : float
        That it took [s], [rad]; the travel is that of the samples.
    samples : int
        That came meanwhile; 0: it was braked by the last known velocity alone, and only for some cycles.
    """

    velocity: float
    left: float
    time: float
    travel: float
    samples: int


def brake_after(
    cause: BaseException,
    drive: Drive,
    joint: MovingJoint | None,
    limits: SessionLimits,
    options: SessionOptions,
    follower: Follower | None,
) -> Braked | None:
    """Brake behind a stop that allows it; None where it does not, or the joint's inertia is not known.

    Raises
    ------
    DriveFaultError
        The drive fails.
    """
    sample = None if follower is None else follower.newest
    if joint is None or follower is None or sample is None:
        return None
    if not isinstance(cause, LimitError) or cause.limit not in BRAKED:
        return None
    return brake(
        *(drive, joint, limits, sample, follower.velocity),
        period=options.period,
        timeout=options.timeout,
    )


def brake(
    drive: Drive,
    joint: MovingJoint,
    limits: SessionLimits,
    sample: DriveSample,
    velocity: float,
    *,
    period: float,
    timeout: float,
) -> Braked | None:
    """Brake a joint until it hardly moves; the motor is still on behind this.

    The first torque follows from the last known velocity, at once. A joint heavier than believed is braked
    on while it becomes slower. It ends early, at the last torque, when the joint does not become slower,
    reverses, or cannot be seen.

    Parameters
    ----------
    drive : Drive
    joint : MovingJoint
    limits : SessionLimits
        Torque and velocity: a joint that seems much faster is not braked, because its encoder is not believed;
        and how many samples may be lost in a row.
    sample : DriveSample
        The last one.
    velocity : float
        Known with it [rad/s].
    period, timeout : float
        Period of the cycles, and timeout of an answer [s].

    Returns
    -------
    Braked or None
        None: it cannot be told how to brake.

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

    def against(speed: float) -> float:
        """The torque [N·m], softer at the end: within two cycles it would turn round."""
        return min(most, joint.inertia * speed / (2.0 * period))

    speed, direction = abs(velocity), 1.0 if velocity > 0.0 else -1.0
    if not speed <= _CREDIBLE * limits.velocity:
        speed = 0.0
    # Also a zero: what held until now may have driven the joint, and a drive wants to hear its host.
    drive.command(-direction * against(speed))
    seen = lost = cycle = 0
    most_lost = max(_LOST, 2 * limits.late_samples)  # more than a burst that ends a session
    # Speeds: known at the beginning, seen since, and when `end` was set last.
    begun, before, mark = speed, 0.0, 0.0
    marked, end = begin, begin + max(_SHORTEST, (most_lost + 2) * period)
    bound = end
    while True:
        cycle += 1
        clock.sleep_until(begin + cycle * period)
        now = clock.now()
        if now >= end:
            slower = mark - speed
            enough = min(_MUCH_SLOWER * mark, _SLOWER * deceleration * (now - marked))
            if now >= bound or not slower > enough:
                break
            mark, marked, end = speed, now, min(bound, now + _SHORTEST)
        try:
            sample = drive.read(timeout)
        except DriveFaultError as error:
            lost += 1
            if error.kind != "stale_position":
                raise
            if lost > most_lost:
                break
            speed = max(0.0, speed - period * most / joint.inertia)  # it may be as slow by now
            drive.command(-direction * against(speed))
            continue
        lost = 0
        if not sample.time > last.time:
            break
        velocity = (sample.position - last.position) / (sample.time - last.time)
        last = sample
        if abs(velocity) > _CREDIBLE * limits.velocity:
            break
        seen += 1
        if seen == 1:
            mark, marked, direction = abs(velocity), now, 1.0 if velocity > 0.0 else -1.0
            expected = mark / deceleration
            end = now + max(_SHORTEST, _LONGEST * expected)
            bound = now + max(_SHORTEST, _BOUND * expected)
        speed = direction * velocity
        if seen <= _TRIED:
            before = max(before, speed)
        if speed < _AT_REST or speed > before:
            break
        drive.command(-direction * against(speed))
    return Braked(
        velocity=max(begun, before),
        left=speed,
        samples=seen,
        time=clock.now() - begin,
        travel=last.position - first.position,
    )
