"""Folded section: quality of the fit, data and settings."""

from __future__ import annotations

from jointid.base.result import Result, kind_of
from jointid.report.page.content import Part, pairs
from jointid.report.page.extras import Extras

_BASIS = {"estimate": "Recording", "robot": "Recording", "servo": "Recording"}


def content(result: Result, extras: Extras) -> list[Part]:
    """Return one folded part for each group of facts with lines."""
    seen = extras.overview
    return [
        Part(heading, (pairs(lines),), f"{extras.prefix}{name}", "folded")
        for heading, name, lines in (
            (_BASIS.get(kind_of(result), "Facts"), "recording", seen.facts),
            ("Fit", "fit", seen.fit),
            ("Settings", "settings", seen.settings),
        )
        if lines
    ]
