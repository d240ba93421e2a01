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
    for name, each in inner.items():
        prefix = f"{extras.prefix}{slug(name)}-"
        shown = extras.parts_of(each, replace(extras, prefix=prefix, recordings=()))
        look: Look = "folded" if kind_of(result) == "joints" else "open"
        heading = _HEADING.get(kind_of(result), "Identified with {}").format(name)
        parts.append(Part(heading, (), f"{extras.prefix}{slug(name)}", look, tuple(shown)))
    return parts


def slug(name: str) -> str:
    """A name as part of a link."""
    return f"of-{''.join(letter if letter.isalnum() else '-' for letter in name)}"
