"""Folded: how well the result explains the data, what it was made from, and with which settings."""

from __future__ import annotations

from jointid.base.result import Result, kind_of
from jointid.report.page.content import Part, pairs
from jointid.report.page.extras import Extras

_BASIS = {"estimate": "Recording", "robot": "Recording", "servo": "Recording"}


def content(result: Result, extras: Extras) -> list[Part]:
    """One folded part for each that has lines."""
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
