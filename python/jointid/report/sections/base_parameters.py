"""Folded: the combinations of a robot's inertial parameters that motion shows."""

from __future__ import annotations

from typing import cast

from jointid.base.result import Result
from jointid.report.page.content import Part, Table, paragraph
from jointid.report.page.extras import Extras
from jointid.robot.result.result import RobotEstimate
from jointid.robot.result.tables import base_rows


def content(result: Result, extras: Extras) -> list[Part]:
    """The table; nothing where the inertia was not identified."""
    rows = base_rows(cast("RobotEstimate", result))
    if not rows:
        return []
    table = Table(
        tuple((name, f"{value} ± {error} {unit}") for value, error, unit, name in rows),
        ("combination", "value ± std. error"),
    )
    said = paragraph(
        "Combinations of the links' inertial parameters that motion shows, about each joint's own frame."
    )
    name = f"{extras.prefix}base-parameters"
    return [Part("Base parameters", (said, table), name, "folded")]
