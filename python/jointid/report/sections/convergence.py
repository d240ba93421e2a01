"""Section with the search, generation by generation."""

from __future__ import annotations

from typing import cast

from jointid.base.result import Result
from jointid.estimate.estimate import Estimate
from jointid.panels.search import convergence
from jointid.report.page.content import Figure, Part
from jointid.report.page.extras import Extras


def content(result: Result, extras: Extras) -> list[Part]:
    """Return the picture; empty if the search has none."""
    estimate = cast("Estimate", result)
    if estimate.convergence is None:
        return []
    name = f"{extras.prefix}convergence"
    return [Part("Convergence", (Figure(convergence(estimate)),), name, "folded")]
