"""Folded section: measured and fitted torque of each joint of a robot, and the residual."""

from __future__ import annotations

from typing import cast

from jointid.base.result import Result
from jointid.panels.robot_friction import windows_of_joint
from jointid.report.page.content import Figure, Part
from jointid.report.page.extras import Extras
from jointid.robot.result.result import RobotEstimate


def content(result: Result, extras: Extras) -> list[Part]:
    """Return one part for each joint, largest residual first."""
    estimate = cast("RobotEstimate", result)
    joints = sorted(estimate.joints.values(), key=lambda joint: -joint.relative_residual)
    parts = tuple(
        Part(joint.name, (Figure(windows_of_joint(estimate, joint.name)),))
        for joint in joints
        if joint.windows.start.size
    )
    heading = "Windows of each joint"
    return [Part(heading, (), f"{extras.prefix}windows", "folded", parts)] if parts else []
