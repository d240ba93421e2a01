"""Assumptions about recordings and robot that no fact states, and checks whether they are plausible."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from jointid.base.advice import Action
from jointid.estimate.findings import Finding, Measured
from jointid.recording.wide.robot_recording import RobotRecording
from jointid.robot.fit.attempt import Attempt
from jointid.robot.links.robot import Robot
from jointid.robot.result.finding_types import TYPES, listed

_MOVES = 0.01  # [rad or m]
_DEGREES = 180.0 / np.pi
_NEAR = 0.1  # of a logarithm: tolerance of the ratio between radians and degrees


def assumption_findings(
    recordings: Sequence[RobotRecording], robot: Robot, attempt: Attempt
) -> Iterator[Finding]:
    """Yield findings of assumptions: the order of joints, omitted joints, no gravity, and signals in degrees.

    `robot` has the facts as stated.
    """
    for run in recordings:
        columns = robot.columns_of(run)
        taken = [run.names[column] for column in columns]
        if columns == list(range(robot.n)) and not set(taken) & set(robot.names):
            pairs = zip(robot.names, taken, strict=True)
            yield TYPES["joints_in_order"].finding(
                "the recording does not name the URDF's joints; the recorded joints are taken in the URDF's order",
                details=", ".join(f"{name} is {each}" for name, each in pairs),
            )
            break
    yield from _left_out(recordings)
    yield from _locked(recordings, robot)
    if not np.any(robot.tree.gravity):
        yield TYPES["no_gravity"].finding("according to the facts, no gravity acts on this robot")
    yield from _units(recordings, robot, attempt)


def _left_out(recordings: Sequence[RobotRecording]) -> Iterator[Finding]:
    """Yield a finding of the joints of the log that have another clock."""
    others: dict[str, str] = {}
    for run in recordings:
        named = run.metadata.get("joints_left_out")
        others |= (
            {str(k): str(why) for k, why in named.items()} if isinstance(named, Mapping) else {}
        )
    if others:
        yield TYPES["joints_left_out"].finding(
            f"left out: {listed([*others])}, because the robot's joints were logged at other times",
            details="; ".join(f"{name}: {why}" for name, why in others.items()),
        )


def _locked(recordings: Sequence[RobotRecording], robot: Robot) -> Iterator[Finding]:
    """Yield findings of joints of the URDF that were left out and move."""
    for name in robot.tree.locked:
        spans = [
            float(np.ptp(run.position[:, run.names.index(name)]))
            for run in recordings
            if name in run.names
        ]
        if spans and max(spans) > _MOVES:
            yield TYPES["locked_joint_moves"].finding(
                f"{name} moves by {max(spans):.3g} (rad or m) and is not one of the robot's joints",
                Action("inspect", text=f"the list of the robot's joints: {name} is missing there"),
                details=f"{name} is assumed to stay at 0",
                evidence={"range": Measured(max(spans))},
            )


def _units(
    recordings: Sequence[RobotRecording], robot: Robot, attempt: Attempt
) -> Iterator[Finding]:
    """Yield findings of joints with velocities in another unit than their positions."""
    for joint, name in enumerate(robot.names):
        ratio = None if robot.tree.prismatic[joint] else _of_velocity(recordings, robot, joint)
        if ratio is None or abs(abs(np.log(ratio)) - np.log(_DEGREES)) >= _NEAR:
            continue
        signal = "velocity" if ratio > 1.0 else "position"
        moved = max(float(np.ptp(each.position[joint])) for each in attempt.excerpts.values())
        yield TYPES["implausible_unit"].finding(
            f"the {signal} of {name} is probably in degrees, not radians",
            Action("inspect", text=f"the unit of the {signal} of {name}"),
            details=f"its recorded velocity is {ratio:.3g} times the derivative of its position",
            evidence={"range": Measured(moved, "rad")},
        )


def _of_velocity(recordings: Sequence[RobotRecording], robot: Robot, joint: int) -> float | None:
    """Return the ratio of the recorded velocity to the position's derivative; None if there is none."""
    run = recordings[0]
    if run.velocity is None:
        return None
    column = robot.columns_of(run)[joint]
    recorded = float(np.median(np.abs(run.velocity[:, column])))
    every = max(1, run.samples // 200)  # a large distance, against the positions' noise
    time, position = run.time[::every], run.position[::every, column]
    derived = float(np.median(np.abs(np.diff(position) / np.diff(time))))
    return recorded / derived if recorded > 0.0 and derived > 0.0 else None
