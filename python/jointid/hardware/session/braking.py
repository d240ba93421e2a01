"""Controlled braking: torque against the motion before the motor is switched off."""

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
"""Stops after which the joint is braked: its position is known, and the drive has followed its commands."""

_AT_REST = 0.02  # [rad/s]
_LONGEST = 2.0  # multiple of the expected time; longer only while the joint slows down
_BOUND = 20.0  # multiple of the expected time, in any case
_SHORTEST = 0.05  # [s]
_SLOWER = 0.05  # share of the expected deceleration
_MUCH_SLOWER = 0.2  # share of the speed, within _SHORTEST
_LOST = 5  # samples in a row, at least; the torque then assumes that the joint slows down
_TRIED = 5  # cycles; after them the joint must be slower
_CREDIBLE = 1.5  # multiple of the velocity limit


@dataclass(frozen=True, slots=True, kw_only=True)
class Braked:
    """How a joint was braked.

    Attributes
    ----------
    velocity, left : float
        Speed before and after braking [rad/s]; estimated if no sample arrived.
    time, travel : float
        Duration [s] and distance [rad] of braking; the distance comes from the samples.
    samples : int
        Number of samples during braking. 0: only the last known velocity was used, for a few cycles.
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
    """Brake after a stop that allows it. Return None if it does not, or if the joint's inertia is not known.

    Raises
    ------
    DriveFaultError
        The drive failed.
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
    """Brake a joint until it hardly moves. The motor is still on afterwards.

    The first torque follows at once from the last known velocity. If the joint is heavier than its file states, braking
    goes on while the joint slows down. Braking ends early, at the last torque, if the joint does not slow down, if it
    reverses, or if no samples arrive.

    Parameters
    ----------
    drive : Drive
    joint : MovingJoint
    limits : SessionLimits
        Torque, velocity and the number of samples that may be lost in a row. A joint that seems much faster than
        the velocity limit is not braked, because its encoder is not trusted.
    sample : DriveSample
        Last sample.
    velocity : float
        Velocity at that sample [rad/s].
    period, timeout : float
        Period of the cycles, and longest wait for an answer [s].

    Returns
    -------
    Braked or None
        None if no safe braking torque is known.

    Raises
    ------
    DriveFaultError
        The drive failed; only switching the motor off remains.
    """
    braking = joint.braking(limits.torque)
    if braking is None:
        return None
    most, deceleration = braking
    clock = drive.clock
    begin, first, last = clock.now(), sample, sample

    def against(speed: float) -> float:
        """Return the torque [N·m]; lower near rest, because the full torque would reverse the joint in two cycles."""
        return min(most, joint.inertia * speed / (2.0 * period))

    speed, direction = abs(velocity), 1.0 if velocity > 0.0 else -1.0
    if not speed <= _CREDIBLE * limits.velocity:
        speed = 0.0
    # A torque of 0 is sent, too: the held torque may drive the joint, and the drive needs a sign of life.
    drive.command(-direction * against(speed))
    seen = lost = cycle = 0
    most_lost = max(_LOST, 2 * limits.late_samples)  # longer than a burst that ends a session
    # Speeds: known at the beginning, largest seen since, and when `end` was set last.
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
            speed = max(0.0, speed - period * most / joint.inertia)  # it may already be this slow
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
