"""Section with measured and fitted windows, and the residual over velocity."""

from __future__ import annotations

from typing import cast

from jointid.base.result import Result
from jointid.estimate.estimate import Estimate
from jointid.panels.windows import residuals_over_velocity, window_means
from jointid.report.page.content import Figure, Part
from jointid.report.page.extras import Extras


def content(result: Result, extras: Extras) -> list[Part]:
    """Return two pictures next to each other; empty for an estimate without windows."""
    estimate = cast("Estimate", result)
    if not estimate.windows.start.size:
        return []
    return [
        Part("Windows", (Figure(window_means(estimate)),), f"{extras.prefix}windows", "half"),
        Part(
            "Residual over velocity",
            (Figure(residuals_over_velocity(estimate)),),
            f"{extras.prefix}residual",
            "half",
        ),
    ]
