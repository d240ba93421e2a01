"""Folded section: the combinations of a robot's inertial parameters that motion shows."""

from __future__ import annotations

from typing import cast

from jointid.base.result import Result
from jointid.estimate.overview import quantity_of
from jointid.report.page.content import Part, Table, paragraph
from jointid.report.page.extras import Extras
from jointid.report.page.wording import value_cell
from jointid.robot.result.result import RobotEstimate


def content(result: Result, extras: Extras) -> list[Part]:
    """Return the table; empty if the inertia was not identified."""
    found = cast("RobotEstimate", result).base_parameters.values()
    if not found:
        return []
    table = Table(
        tuple((p.name, value_cell(quantity_of(p, p.name))) for p in found),
        ("combination", "value ± std. error"),
    )
    said = paragraph(
        "Combinations of the links' inertial parameters that the motion determines, in the frame of each joint."
    )
    name = f"{extras.prefix}base-parameters"
    return [Part("Base parameters", (said, table), name, "folded")]
