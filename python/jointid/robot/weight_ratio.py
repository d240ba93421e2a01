"""Ratio of a robot's torques to the torques of its URDF's links, which first shows wrong units and gear ratios."""

from __future__ import annotations

from dataclasses import replace

from jointid.recording.wide.robot_recording import RobotRecording
from jointid.robot.checks.link_factors import weight_factors
from jointid.robot.links.robot import Robot
from jointid.robot.motion.plain_motion import plain_signals


def weight_scales(recording: RobotRecording, robot: Robot) -> dict[str, float | None]:
    """Return the ratio of each joint's torque to the torque that the URDF's links need; None if they do not explain it.

    For a recording with currents only, the ratio is in A per N·m, regardless of the robot's torque constants.

    Parameters
    ----------
    recording : RobotRecording
    robot : Robot

    Raises
    ------
    InputError
        The recording lacks a joint of the robot, or torques and currents.
    """
    lacks = recording.torque is None and recording.motor_torque is None
    if lacks and recording.current is not None:
        robot = replace(robot, torque_constants=(1.0,) * robot.n)
    factors = weight_factors(plain_signals([recording], robot), robot)
    return {name: factors.get(joint) for joint, name in enumerate(robot.names)}
