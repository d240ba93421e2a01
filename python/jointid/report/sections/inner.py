"""Section with the inner results: a comparison's chosen model, each joint, or a session's last estimate."""

from __future__ import annotations

from dataclasses import replace

from jointid.base.result import Result, kind_of
from jointid.report.page.content import Look, Part
from jointid.report.page.extras import Extras

_HEADING = {"joints": "Joint {}", "commissioning": "Identified in {}"}


def content(result: Result, extras: Extras) -> list[Part]:
    """Return each inner result under its name. Several results are folded."""
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
    """Return the name of the part with an inner result, by number, because joints' names may be equal in a link."""
    return f"{extras.prefix}of-{number + 1}"
