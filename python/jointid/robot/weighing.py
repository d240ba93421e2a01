"""How much a robot's torques are of what its URDF's links weigh: the first thing that units and gears show."""

from __future__ import annotations

from dataclasses import replace

from jointid.recording.wide.robot_recording import RobotRecording
from jointid.robot.checks.link_factors import weight_factors
from jointid.robot.links.robot import Robot
from jointid.robot.motion.plain_motion import plain_signals


def weight_scales(recording: RobotRecording, robot: Robot) -> dict[str, float | None]:
    """Return each joint's torque over what the URDF's links need; None where links do not explain it.

    Of a recording with currents only it is in A per N·m, whatever the robot's torque constants.

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
