"""`simulate` of a robot along its logs, moved by logged torques or by its position loop."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from jointid.base.errors import InputError
from jointid.estimate.rollout import Rollout, RunRollout
from jointid.joint.checks import positive_number
from jointid.recording.wide.robot_recording import RobotRecording
from jointid.robot.motion.motion import Motion, part_of
from jointid.robot.result.prediction import motion_of
from jointid.robot.result.record import RobotEstimateRecord
from jointid.robot.rollout.arm import Arm
from jointid.robot.rollout.driving import Driving, driving_of
from jointid.robot.rollout.stepping import State, moved

Array = NDArray[np.float64]

STEP = 1e-3
"""Default of the longest integration step [s]."""
HORIZON = 0.5
"""Default length of a stretch with logged torques [s]: errors of an open loop grow without a limit."""

LONGEST = 20.0
"""Simulated time of each recording [s]: more time adds no information."""

_OUT_OF_BOUNDS = 1e6  # rad/s


def rollout_robot(
    estimate: RobotEstimateRecord,
    recordings: RobotRecording | Sequence[RobotRecording],
    *,
    horizon: float | None = None,
    step: float = STEP,
) -> Rollout:
    """Simulate a robot along logs by their torques or by its position loop, and compare the positions.

    Each stretch of `horizon` seconds starts from the logged positions and velocities; a closed loop needs only one.
    At most the first 20 s of each recording are simulated.

    Returns
    -------
    Rollout
        One run for each recording and joint; `before` is the error with the URDF's values and no friction.
    """
    runs = [recordings] if isinstance(recordings, RobotRecording) else list(recordings)
    if not runs:
        raise InputError("at least one recording is expected", argument="recordings", value=[])
    drive = estimate.robot.drive
    if drive is not None and drive.free:
        raise InputError(
            f"the gain of {estimate.robot.names[drive.free[0]]} is free, so its position loop cannot be simulated",
            argument="subject",
            remedy="state kp of this joint",
        )
    step, closed = positive_number("", "step", step), drive is not None
    if horizon is not None:
        horizon = positive_number("", "horizon", horizon)
    elif not closed:
        horizon = HORIZON
    arm, nominal = Arm.of(estimate), Arm.nominal(estimate)
    found: list[RunRollout] = []
    for number, recording in enumerate(runs):
        end = int(np.searchsorted(recording.time, recording.time[0] + LONGEST, "right"))
        recording = part_of(recording, 0, end)
        motion = motion_of(estimate, recording, mask_standstill=False)
        driving = driving_of(motion, estimate.robot, recording)
        simulated = _along(arm, motion, driving, horizon, step)
        before = _along(nominal, motion, driving, horizon, step)
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
                    closed=closed,
                    kind="prismatic" if estimate.robot.tree.prismatic[k] else "revolute",
                )
            )
    return Rollout(runs=tuple(found), horizon=horizon)


def _along(
    arm: Arm, motion: Motion, driving: Driving, horizon: float | None, longest: float
) -> tuple[Array, Array]:
    """Return positions and velocities (n, samples) of the simulated motion."""
    time = motion.time
    position, velocity = np.empty_like(motion.position), np.empty_like(motion.velocity)
    slopes = np.gradient(motion.velocity, time, axis=1)
    state, end = State(motion.position[:, 0], motion.velocity[:, 0], slopes[:, 0]), np.inf
    for row in range(len(time)):
        if row == 0 or time[row] >= end:
            state = State(motion.position[:, row], motion.velocity[:, row], slopes[:, row])
            end = np.inf if horizon is None else time[row] + horizon
        position[:, row], velocity[:, row] = state.position, state.velocity
        if row + 1 == len(time):
            break
        duration = float(time[row + 1] - time[row])
        count = max(1, int(np.ceil(duration / longest - 1e-9)))
        for k in range(count):
            push = driving.push(row, (k + 0.5) / count, state)
            state = moved(arm, state, push, duration / count)
        if not np.abs(state.velocity).max() < _OUT_OF_BOUNDS:
            raise InputError(
                "the simulation diverges",
                argument="recordings",
                remedy="give a shorter horizon",
            )
    return position, velocity
