"""Section of a comparison: the chosen model with the reason, and each candidate's error on held-out data."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any, cast

from jointid.base.result import Result, kind_of
from jointid.comparison.result import Comparison
from jointid.estimate.wording import percent_with_error
from jointid.panels.comparison import held_out, held_out_robot, held_out_servo
from jointid.panels.marks import Picture
from jointid.report.page.content import Block, Figure, Item, Items, Part, Table, paragraph
from jointid.report.page.extras import Extras
from jointid.robot.result.comparison_result import RobotComparison
from jointid.servo.comparison_result import ServoComparison

_HEAD = ("model", "held-out residual", "remark")


def content(result: Result, extras: Extras) -> list[Part]:
    """Return the table next to the picture, and then the method of the comparison."""
    tables, below, picture = {
        "comparison": _of_joint,
        "robot comparison": _of_robot,
        "servo comparison": _of_servo,
    }[kind_of(result)](result)
    prefix = extras.prefix
    return [
        Part("Candidates", tuple(tables), f"{prefix}models", "half"),
        Part("Held-out error", (Figure(picture),), f"{prefix}held-out", "half"),
        Part("", tuple(below)),
    ]


def _of_joint(result: Result) -> tuple[list[Block], list[Block], Picture]:
    comparison = cast("Comparison", result)
    below = [paragraph(comparison.setting(), muted=True), *_left_out(comparison.settings)]
    rows = tuple(
        (
            f"{row.model}, {row.parameters} parameters",
            percent_with_error(row.score, row.stderr),
            row.reason,
        )
        for row in comparison.rows
    )
    return [Table(rows, _HEAD)], below, held_out(comparison)


def _left_out(settings: Mapping[str, Any]) -> list[Block]:
    """Return the candidates that could not be compared, with the reasons."""
    left = settings["left_out"].items()
    if not left:
        return []
    lines = tuple(Item((f"{model}: {reason}",)) for model, reason in left)
    return [paragraph("Not compared:"), Items(lines)]


def _of_robot(result: Result) -> tuple[list[Block], list[Block], Picture]:
    found = cast("RobotComparison", result)
    rows = tuple(
        (
            f"{row.name}, {row.parameters} parameters",
            percent_with_error(row.score, row.stderr),
            row.reason,
        )
        for row in found.rows
    )
    joints = Table(tuple(map(tuple, found.joint_cells())), ("", *found.models))
    below: list[Block] = [
        paragraph("Held-out residual of each joint:"),
        joints,
        paragraph(found.setting(), muted=True),
        *_left_out(found.settings),
    ]
    return [Table(rows, _HEAD)], below, held_out_robot(found)


def _of_servo(result: Result) -> tuple[list[Block], list[Block], Picture]:
    found = cast("ServoComparison", result)
    rows = tuple(
        (
            name,
            f"{math.degrees(found.medians[k]):.2f}",
            f"{math.degrees(found.errors[k].max()):.2f}",
            str(int(found.bistable[k].sum())),
        )
        for k, name in enumerate(found.models)
    )
    setting = (
        f"Closed loop of {len(found.runs)} runs, held out in {len(set(found.groups))} groups: mean absolute error of "
        "the position."
    )
    head = ("model", "median [deg]", "worst [deg]", "bistable runs")
    return (
        [Table(rows, head, numbers=True)],
        [paragraph(setting, muted=True)],
        held_out_servo(found),
    )
