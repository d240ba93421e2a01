"""Section with a designed motion's use of its limits, and its assumptions."""

from __future__ import annotations

from typing import cast

from jointid.base.result import Result
from jointid.excitation.assumptions import assumed
from jointid.excitation.design import Design
from jointid.excitation.tables import improved, judged_with, limits_used
from jointid.report.page.content import Item, Items, Part
from jointid.report.page.extras import Extras


def content(result: Result, extras: Extras) -> list[Part]:
    """Return the two lists."""
    design = cast("Design", result)
    assumptions = (*improved(design), assumed(design), judged_with(design))
    return [
        Part("Limits", (_list(limits_used(design)),), f"{extras.prefix}limits", "half"),
        Part("Assumptions", (_list(assumptions),), f"{extras.prefix}assumptions"),
    ]


def _list(lines: list[str] | tuple[str, ...]) -> Items:
    return Items(tuple(Item((line,)) for line in lines))
