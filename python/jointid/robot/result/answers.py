"""A robot's answer in a few lines: the verdict, a line for each joint, the first finding, and its advice."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from jointid.base.advice import Action
from jointid.base.error_text import printable
from jointid.estimate.answers import findings, in_line, joint_lines, purposes
from jointid.estimate.wording import percent
from jointid.robot.links.parameters import JOINT_FRICTION
from jointid.robot.result.record import RobotEstimateRecord
from jointid.robot.result.verdict import judged_robot

FINDINGS = 1
"""Number of joints that an answer shows in full."""


def answer(
    estimate: RobotEstimateRecord, action: Callable[[Action], str] = str, saved: str = ""
) -> str:
    """Return the answer: at most 7 lines plus one for each joint, with the worst joint first if it is not usable.

    `action` gives the text of an advice. `saved` is the file of the estimate.
    """
    verdict = judged_robot(estimate)
    lines = [
        f"{estimate.robot.name or 'robot'}: {verdict.level}",
        *purposes(verdict),
        *lines_of_joints(estimate, {}),
        *findings(estimate.findings, action, FINDINGS, saved),
    ]
    return printable("\n".join(lines))


def lines_of_joints(estimate: RobotEstimateRecord, models: Mapping[str, str]) -> list[str]:
    """Return a line for each joint with its friction, and its model if `models` contains it."""
    joints = list(estimate.joints.values())
    if judged_robot(estimate).level == "not usable":
        joints.sort(key=lambda joint: -joint.relative_residual)
    present = {name for joint in joints for name in joint.parameters}
    shown = [name for name in JOINT_FRICTION if name in present]
    return joint_lines(
        [
            [
                joint.name,
                *([models[joint.name]] if models else []),
                *(in_line(joint.parameters.get(name)) for name in shown),
                f"residual {percent(joint.relative_residual)}",
            ]
            for joint in joints
        ]
    )
