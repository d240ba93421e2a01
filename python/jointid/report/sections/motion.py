"""Section with a designed motion: position and velocity within their limits, and sampled friction."""

from __future__ import annotations

from typing import cast

from jointid.base.result import Result
from jointid.excitation.design import Design
from jointid.panels.design import motion, sampled_velocities
from jointid.report.page.content import Figure, Part
from jointid.report.page.extras import Extras


def content(result: Result, extras: Extras) -> list[Part]:
    """Return the pictures."""
    design = cast("Design", result)
    prefix = extras.prefix
    return [
        Part("Motion", (Figure(motion(design)),), f"{prefix}motion", "half"),
        Part("Velocities", (Figure(sampled_velocities(design)),), f"{prefix}velocities", "half"),
    ]
