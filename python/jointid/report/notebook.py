"""A result in a notebook: the first parts of its page, with their own style."""

from __future__ import annotations

from jointid.base.html import element
from jointid.base.result import Result
from jointid.report.page.content import Part
from jointid.report.pages import first_parts
from jointid.report.renderers.html_page import html_parts
from jointid.report.renderers.style import NOTEBOOK


def notebook_view(result: Result) -> str:
    """Return the answer, the values, the main picture and the findings, as HTML."""
    title, parts = first_parts(result)
    shown = [Part(title, ()), *(part for part in parts if part.look != "folded")]
    return str(element("div", element("style", NOTEBOOK), *html_parts(shown, 3), class_="jointid"))
