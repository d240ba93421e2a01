"""Section with the friction of each joint as small pictures, two in a row, largest residual first."""

from __future__ import annotations

from dataclasses import replace
from typing import cast

from jointid.base.error_text import joint_phrase
from jointid.base.result import Result, kind_of
from jointid.joints.result import JointEstimates
from jointid.panels.friction import friction_map
from jointid.panels.marks import Picture
from jointid.panels.robot_friction import friction_of_joint
from jointid.report.page.content import Multiples, Part
from jointid.report.page.extras import Extras
from jointid.robot.result.result import RobotEstimate


def content(result: Result, extras: Extras) -> list[Part]:
    """Return the pictures; empty if no joint has any."""
    if kind_of(result) == "robot":
        found = _of_robot(cast("RobotEstimate", result))
    else:
        found = _of_joints(cast("JointEstimates", result))
    pictures = tuple(
        replace(picture, title=f"{name}: residual {100.0 * residual:.1f} %")
        for residual, name, picture in sorted(found, key=lambda each: -each[0])
    )
    if not pictures:
        return []
    heading = "Friction of each joint, the largest residual first"
    return [Part(heading, (Multiples(pictures),), f"{extras.prefix}friction-map")]


def _of_robot(estimate: RobotEstimate) -> list[tuple[float, str, Picture]]:
    return [
        (joint.relative_residual, name, friction_of_joint(estimate, name))
        for name, joint in estimate.joints.items()
        if joint.windows.start.size
    ]


def _of_joints(joints: JointEstimates) -> list[tuple[float, str, Picture]]:
    return [
        (estimate.residuals.relative, joint_phrase(name), friction_map(estimate))
        for name, estimate in joints.items()
        if estimate.windows.start.size
    ]
