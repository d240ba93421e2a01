"""`simulate` of a robot along its logs: the logged torques move the arm, short stretch by short stretch."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from jointid.base.errors import InputError
from jointid.estimate.rollout import Rollout, RunRollout
from jointid.joint.checks import positive_number
from jointid.recording.wide.robot_recording import RobotRecording
from jointid.robot.motion.motion import Motion
from jointid.robot.motion.shifts import torque_shift, without_delay
from jointid.robot.motion.stamps import on_even_clock
from jointid.robot.result.record import RobotEstimateRecord
from jointid.robot.rollout.arm import Arm
from jointid.robot.rollout.stepping import moved

Array = NDArray[np.float64]

STEP = 1e-3
"""Longest integration step by default [s]."""
HORIZON = 0.5
"""Length of a stretch by default [s]: errors of an open loop grow without a bound."""

_OUT_OF_BOUNDS = 1e6  # rad/s


def rollout_robot(
    estimate: RobotEstimateRecord,
    recordings: RobotRecording | Sequence[RobotRecording],
    *,
    horizon: float = HORIZON,
    step: float = STEP,
) -> Rollout:
    """Simulate a robot along logs by their torques, and compare the positions.

    Each stretch of `horizon` seconds begins at the logged positions and velocities.

    Returns
    -------
    Rollout
        One run for each recording and joint; `before` is the error of the URDF without friction.
    """
    runs = [recordings] if isinstance(recordings, RobotRecording) else list(recordings)
    if not runs:
        raise InputError("at least one recording is expected", argument="recordings", value=[])
    horizon, step = positive_number("", "horizon", horizon), positive_number("", "step", step)
    arm, nominal = Arm.of(estimate), Arm.nominal(estimate)
    found: list[RunRollout] = []
    for number, recording in enumerate(runs):
        motion = _motion(estimate, recording)
        simulated = _along(arm, motion, horizon, step)
        before = _along(nominal, motion, horizon, step)
        for k, name in enumerate(estimate.robot.names):
            run = (recording.name or f"recording {number + 1}") if len(runs) > 1 else ""
            found.append(
                RunRollout(
                    name=f"{run}, {name}" if run else name,
                    time=motion.time,
                    position=simulated[0][k],
                    velocity=simulated[1][k],
                    measured=motion.position[k],
                    error=float(np.mean(np.abs(simulated[0][k] - motion.position[k]))),
                    before=float(np.mean(np.abs(before[0][k] - motion.position[k]))),
                    closed=False,
                    kind="prismatic" if estimate.robot.tree.prismatic[k] else "revolute",
                )
            )
    return Rollout(runs=tuple(found), horizon=horizon)


def _motion(estimate: RobotEstimateRecord, recording: RobotRecording) -> Motion:
    """Positions, velocities and torques at the joints, without the delays that were found."""
    robot, settings = estimate.robot, estimate.settings
    shift = torque_shift(settings.get("shift", {}), robot)
    return Motion.of(
        without_delay(on_even_clock(recording), robot, shift), robot, np.zeros(robot.n), False
    )


def _along(arm: Arm, motion: Motion, horizon: float, longest: float) -> tuple[Array, Array]:
    """Positions and velocities (n, samples) that the logged torques give."""
    time, torque = motion.time, motion.torque
    position, velocity = np.empty_like(motion.position), np.empty_like(motion.velocity)
    slopes = np.gradient(motion.velocity, time, axis=1)
    began = -np.inf
    for row in range(len(time)):
        if time[row] - began >= horizon or row == 0:
            began, q, v = time[row], motion.position[:, row].copy(), motion.velocity[:, row].copy()
            a = slopes[:, row]
        position[:, row], velocity[:, row] = q, v
        if row + 1 == len(time):
            break
        duration = float(time[row + 1] - time[row])
        count = max(1, int(np.ceil(duration / longest - 1e-9)))
        for k in range(count):
            share = (k + 0.5) / count
            held = motion.torque_held
            now = (
                torque[:, row]
                if held
                else (1.0 - share) * torque[:, row] + share * torque[:, row + 1]
            )
            before = v
            q, v = moved(arm, q, v, a, now, duration / count)
            a = (v - before) * count / duration
        if not np.abs(v).max() < _OUT_OF_BOUNDS:
            raise InputError(
                "the simulated motion leaves all bounds",
                argument="recordings",
                remedy="give a shorter horizon",
            )
    return position, velocity
