"""Every kind of result has a page in every format, and a new section or format is one file and one row."""

import html
import sys
from collections.abc import Callable
from types import ModuleType

import pytest
import report_pages
from report_pages import PAGES, Shown, page, shown

from jointid.base.result import KINDS, kind_of
from jointid.report import renderers, sections
from jointid.report.page.content import Bold, Page, Paragraph, Part, paragraph
from jointid.report.page.extras import Extras
from jointid.report.pages import page_of
from jointid.report.renderers import RENDERERS, html_page, markdown, plain_text
from jointid.report.saving import report_page
from jointid.report.sections import SECTIONS


def headings(parts: tuple[Part, ...]) -> list[str]:
    return [
        name
        for part in parts
        for name in (*([part.heading] if part.heading else []), *headings(part.inner))
    ]


@pytest.mark.parametrize("make", PAGES, ids=lambda each: each.__name__)
def test_every_format_has_all_headings(make: Callable[[], Shown]) -> None:
    each = shown(make)
    extras = Extras(recordings=tuple(each.recordings or ()), rollout=each.rollout)
    made = page_of(each.result, extras)
    wanted = headings(made.parts)
    for ending in RENDERERS:
        text = html.unescape(page(make, ending)).replace("\\", "")
        at = 0
        for heading in wanted:
            at = text.index(heading, at) + len(heading)
        assert ("<svg" in text) <= ending.startswith(".htm")


def test_every_kind_has_a_section_besides_the_answer() -> None:
    general = {name for name, kinds in SECTIONS.items() if kinds == KINDS}
    covered = {kind for name, kinds in SECTIONS.items() if name not in general for kind in kinds}
    assert covered == set(KINDS)
    assert {kind_of(shown(make).result) for make in PAGES} == set(KINDS)


def test_names_of_parts_are_unique() -> None:
    for make in PAGES:
        text = page(make)
        names = [each.partition('"')[0] for each in text.split(' id="')[1:]]
        assert len(set(names)) == len(names)


def test_a_new_section_is_a_file_and_a_row(monkeypatch: pytest.MonkeyPatch) -> None:
    file = ModuleType("jointid.report.sections.weather")
    file.content = lambda *_: [Part("Weather", (paragraph("rain"),))]  # type: ignore[attr-defined]
    monkeypatch.setitem(sys.modules, file.__name__, file)
    monkeypatch.setitem(sections.SECTIONS, "weather", ("estimate",))
    each = shown(report_pages.of_a_joint)
    assert "rain" in report_page(each.result)
    assert "rain" not in report_page(shown(report_pages.of_a_design).result)


def test_a_new_format_is_a_file_and_a_row(monkeypatch: pytest.MonkeyPatch) -> None:
    file = ModuleType("jointid.report.renderers.titles")
    file.render = lambda made: "\n".join(headings(made.parts))  # type: ignore[attr-defined]
    monkeypatch.setitem(sys.modules, file.__name__, file)
    monkeypatch.setitem(renderers.RENDERERS, ".titles", "titles")
    made = report_page(shown(report_pages.of_a_joint).result, ending=".titles")
    assert made.splitlines()[:2] == ["Parameters", "Friction map"]


def test_nothing_in_a_text_is_syntax() -> None:
    hostile = "a|b *c* <i>d</i> [e](f)\n# g"
    made = Page(hostile, (Part("", (paragraph(hostile), Paragraph((Bold(hostile),)))),))
    text = markdown.render(made)
    assert "<i>" not in text.replace("\\<", "")
    assert not [line for line in text.splitlines()[1:] if line.startswith("#")]
    assert "<i>" not in html_page.render(made)
    assert plain_text.render(made).count(hostile.splitlines()[0]) == 3
