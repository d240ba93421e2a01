"""Section with a robot's joints: one row each, value and error in one cell."""

from __future__ import annotations

from typing import cast

from jointid.base.result import Result, kind_of
from jointid.joints import tables as joints_tables
from jointid.joints.result import JointEstimates
from jointid.report.page.content import Link, Part, Run, Table
from jointid.report.page.extras import Extras
from jointid.report.sections.inner import place_of
from jointid.robot.result import tables as robot_tables
from jointid.robot.result.result import RobotEstimate


def content(result: Result, extras: Extras) -> list[Part]:
    """Return the table."""
    if kind_of(result) == "robot":
        robot = cast("RobotEstimate", result)
        head, rows = robot_tables.head(robot), robot_tables.rows(robot)
    else:
        joints = cast("JointEstimates", result)
        head, rows = joints_tables.head(joints), joints_tables.rows(joints)
        levels = (
            "failed" if each.estimate is None else each.estimate.verdict.level
            for each in joints.results.values()
        )
        head = [head[0], "verdict", *head[1:]]
        rows = [[name, level, *cells] for level, (name, *cells) in zip(levels, rows, strict=True)]
    places = {name: place_of(number, extras) for number, name in enumerate(extras.overview.inner)}
    cells: tuple[tuple[Run, ...], ...] = tuple(
        (Link(name, places[name]) if name in places else name, *others) for name, *others in rows
    )
    table = Table(cells, tuple(head))
    return [Part("Joints", (table,), f"{extras.prefix}joints")]
