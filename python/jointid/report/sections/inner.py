"""The results that a result consists of: the winner's estimate of a comparison, each joint's, a session's last."""

from __future__ import annotations

from dataclasses import replace

from jointid.base.result import Result, kind_of
from jointid.report.page.content import Look, Part
from jointid.report.page.extras import Extras

_HEADING = {"joints": "Joint {}", "commissioning": "Identified in {}"}


def content(result: Result, extras: Extras) -> list[Part]:
    """Each inner result under its name; several are folded."""
    inner = extras.overview.inner
    parts = []
    for number, (name, each) in enumerate(inner.items()):
        place = place_of(number, extras)
        shown = extras.parts_of(each, replace(extras, prefix=f"{place}-", recordings=()))
        look: Look = "folded" if kind_of(result) == "joints" else "open"
        heading = _HEADING.get(kind_of(result), "Identified with {}").format(name)
        parts.append(Part(heading, (), place, look, tuple(shown)))
    return parts


def place_of(number: int, extras: Extras) -> str:
    """The name of the part that shows an inner result, by its number: names of joints may look alike in a link."""
    return f"{extras.prefix}of-{number + 1}"
