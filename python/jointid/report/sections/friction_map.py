"""Section with the friction map: measured windows, and the identified line with its band."""

from __future__ import annotations

from typing import cast

from jointid.base.result import Result
from jointid.estimate.estimate import Estimate
from jointid.panels.friction import friction_map
from jointid.report.page.content import Figure, Part
from jointid.report.page.extras import Extras


def content(result: Result, extras: Extras) -> list[Part]:
    """Return the picture; empty for an estimate without windows."""
    estimate = cast("Estimate", result)
    if not estimate.windows.start.size:
        return []
    name = f"{extras.prefix}friction-map"
    return [Part("Friction map", (Figure(friction_map(estimate)),), name, "half")]
