"""A robot's answer in a few lines: the verdict, a line for each joint, the first finding, and what to do about it."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from jointid.base.advice import Action
from jointid.base.error_text import printable
from jointid.estimate.answers import cut, findings, in_line, joint_lines, purposes
from jointid.estimate.wording import percent, rounded, two_digits
from jointid.robot.comparison_result import ComparedRobotModel, RobotComparison
from jointid.robot.parameters import JOINT_FRICTION
from jointid.robot.result import RobotEstimate

_FINDINGS = 1


def answer(estimate: RobotEstimate, action: Callable[[Action], str] = str, saved: str = "") -> str:
    """Return the answer in at most 7 lines and one for each joint, the worst joint first where it is not usable.

    `action` words an advice; `saved` is the file that has the estimate.
    """
    lines = [
        f"{estimate.robot.name or 'robot'}: {estimate.verdict.level}",
        *purposes(estimate.verdict),
        *_joints(estimate, {}),
        *findings(estimate.findings, action, _FINDINGS, saved),
    ]
    return printable("\n".join(lines))


def answer_of_comparison(
    found: RobotComparison, action: Callable[[Action], str] = str, saved: str = ""
) -> str:
    """Return the winner with each joint's model and values, in at most 7 lines and one for each joint."""
    estimate, winner = found.estimate, found.winner
    others = sorted((row for row in found.rows if row != winner), key=lambda row: row.score)
    runner_up = f", next {others[0].name} {_score(others[0])}" if others else ""
    lines = [
        f"{estimate.robot.name or 'robot'}: {winner.name} of {len(found.rows)} candidates, {estimate.verdict.level}",
        cut(f"  held-out residual {_score(winner)}{runner_up}"),
        *_joints(estimate, found.models),
        *findings(estimate.findings, action, _FINDINGS, saved),
    ]
    return printable("\n".join(lines))


def _joints(estimate: RobotEstimate, models: Mapping[str, str]) -> list[str]:
    joints = list(estimate.joints.values())
    if estimate.verdict.level == "not usable":
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


def _score(row: ComparedRobotModel) -> str:
    value, error = 100.0 * row.score, 100.0 * row.stderr
    return f"{rounded(value, error) if error > 0.0 else f'{value:.3g}'} ± {two_digits(error)} %"
