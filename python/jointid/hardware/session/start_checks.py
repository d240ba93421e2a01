"""Reasons not to start a session, before the motor is on."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from jointid import _core
from jointid.base.errors import InputError
from jointid.hardware.session.drive import Drive, DriveSample
from jointid.hardware.session.foresight import foresight_of
from jointid.hardware.session.limits import SessionLimits
from jointid.hardware.session.moving_joint import MovingJoint
from jointid.hardware.session.options import MOST_CYCLES, SessionOptions
from jointid.hardware.session.stop import LimitError
from jointid.simulation.arguments import Controller
from jointid.simulation.trajectory import Trajectory

_FEWEST = 8  # samples of a recording
SHORTEST_APPROACH = 0.2  # s
FULLEST_BUS = 0.8  # share of the bus time; the rest is for an emergency message or a repeated frame


def problems_on_paper(
    drive: Drive,
    controller: Controller,
    trajectory: Trajectory,
    limits: SessionLimits,
    options: SessionOptions,
    joint: MovingJoint | None,
) -> Iterator[str]:
    """Yield problems that are known before the bus is used: its load, the trajectory."""
    period = options.period
    load = drive.bus_load(period)
    if not load <= FULLEST_BUS:
        yield (
            f"the bus load is {100.0 * load:.0f} %, more than {100.0 * FULLEST_BUS:.0f} %; state a longer "
            "period"
        )
    if trajectory.duration < _FEWEST * period:
        yield (
            f"the trajectory lasts {trajectory.duration:g} s; at least {_FEWEST} periods of {period:g} s are expected"
        )
        return
    wanted, speed, _ = trajectory.sample(np.arange(0.0, trajectory.duration, period))
    if isinstance(controller, _core.OpenLoop):
        largest = float(np.abs(wanted).max())
        if largest > limits.torque:
            yield f"the trajectory needs {largest:.4g} N·m, more than {limits.torque:.4g} N·m"
        return
    low, high = limits.position
    if not (wanted.min() >= low and wanted.max() <= high):
        yield (
            f"the trajectory goes from {wanted.min():.4f} to {wanted.max():.4f} rad, outside the window of "
            f"{low:.4f} to {high:.4f} rad"
        )
    fastest = float(np.abs(speed).max())
    if fastest > limits.velocity:
        yield f"the trajectory reaches {fastest:.3f} rad/s, more than {limits.velocity:g} rad/s"
    watching = foresight_of(joint, drive, limits, options)
    if watching is not None:
        try:
            watching.whole(wanted, speed)
        except LimitError as error:
            yield f"the trajectory is too fast near the edge of the window: {error}"


def problems_of_drive(drive: Drive, limits: SessionLimits) -> list[str]:
    """Return the problems that a connected drive reports.

    Raises
    ------
    InputError
        The drive does not return a list.
    """
    problems: object = drive.problems(limits.torque)
    if not isinstance(problems, list):
        raise InputError(
            "a list of sentences is expected from a drive", argument="problems()", value=problems
        )
    return problems


def check_approach(distance: float, options: SessionOptions) -> None:
    """Check that the motion to the start has no more cycles than a session can keep.

    Parameters
    ----------
    distance : float
        Distance to the start of the trajectory [rad].
    options : SessionOptions

    Raises
    ------
    InputError
        The velocity is too low; the message names the lowest possible one.
    """
    longest = MOST_CYCLES * options.period
    if approach_time(distance, options) <= longest:
        return
    least = 0.5 * math.pi * abs(distance) / longest
    raise InputError(
        f"at least {least:.3g} rad/s is expected, because the start is {abs(distance):.3g} rad away "
        f"and a session has at most {MOST_CYCLES} cycles",
        argument="approach_velocity",
        value=options.approach_velocity,
    )


def approach_time(distance: float, options: SessionOptions) -> float:
    """Return the duration of the motion to the start [s], for a distance [rad]."""
    return max(SHORTEST_APPROACH, 0.5 * math.pi * abs(distance) / options.approach_velocity)


def approach_to(distance: float, options: SessionOptions) -> Trajectory:
    """Return the motion to the start and the rest there, for a distance [rad]."""
    rise = approach_time(distance, options)
    return Trajectory.sigmoid(distance, rise=rise, duration=rise + options.settle)


def problems_at_rest(sample: DriveSample, limits: SessionLimits) -> Iterator[str]:
    """Yield problems with the state of a connected drive with its motor off."""
    low, high = limits.position
    if not low <= sample.position <= high:
        yield (
            f"the joint is at {sample.position:.4f} rad, outside {low:.4f} to {high:.4f} rad: is it homed?"
        )
    if sample.clipped:
        yield "the torque sensor is at the end of its range"
    elif not math.isfinite(sample.reading):
        yield f"the torque sensor reads {sample.reading}, which is not finite"
