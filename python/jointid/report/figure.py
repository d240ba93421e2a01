"""A picture with its caption."""

from __future__ import annotations

from jointid.base.html import Html, element
from jointid.report.drawing.marks import Panel
from jointid.report.drawing.picture import drawn


def captioned(caption: str, *panels: Panel) -> Html:
    """A picture of one or several panels below each other, with its caption."""
    return element("figure", drawn(panels, caption), element("figcaption", caption))
