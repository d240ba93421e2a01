"""Render a page as HTML without other files."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from jointid.base.html import Html, element, page
from jointid.report.drawing.picture import drawn
from jointid.report.page.content import (
    Answer,
    Block,
    Bold,
    Code,
    Figure,
    Item,
    Items,
    Link,
    Multiples,
    Page,
    Paragraph,
    Part,
    Run,
    Table,
)
from jointid.report.renderers.style import STYLE

_NARROW = 3  # number of columns that a phone shows without scrolling


def render(shown: Page) -> str:
    """Return a page as one HTML document."""
    body = [element("h1", shown.title), *html_parts(shown.parts)]
    if shown.footer:
        body.append(element("footer", shown.footer))
    return page(shown.title, STYLE, element("main", *body))


def html_parts(parts: Sequence[Part], level: int = 2) -> list[Html]:
    """Return parts below each other, with halves in pairs."""
    made: list[Html] = []
    halves: list[Html] = []
    for part in parts:
        if part.look == "half":
            halves.append(_section(part, level))
            continue
        if halves:
            made.append(element("div", *halves, class_="halves"))
            halves = []
        made += [_folded(part, level)] if part.look == "folded" else _open(part, level)
    if halves:
        made.append(element("div", *halves, class_="halves"))
    return made


def html_block(block: Block, heading: str = "") -> Html:
    """Return one block. The heading above it is the name of scrolling areas."""
    match block:
        case Answer(sentence, level):
            look = f"verdict {level.replace(' ', '-')}".rstrip()
            return element("p", element("b", sentence), class_=look)
        case Paragraph(runs, muted):
            return element("p", *_runs(runs), **({"class_": "muted"} if muted else {}))
        case Items(lines):
            return element("ul", *map(_item, lines), class_="lines")
        case Table():
            return _table(block, heading)
        case Figure(picture):
            caption = ". ".join(filter(None, (picture.title, picture.caption)))
            return _figure(caption, drawn(picture.panels, caption))
        case Code(text):
            return element("pre", text, tabindex="0", role="region", aria_label=heading or "code")
        case Multiples(pictures):
            figures = [
                element(
                    "figure",
                    element("figcaption", element("b", each.title)),
                    drawn(each.panels, f"{each.title}: {each.caption}"),
                )
                for each in pictures
            ]
            grid = element("div", *figures, class_="multiples")
            return _figure(pictures[0].caption if pictures else "", grid, tag="div")


def _figure(caption: str, picture: Html, tag: str = "figure") -> Html:
    words = element("figcaption" if tag == "figure" else "p", caption, class_="caption")
    return element(tag, picture, words)


def _open(part: Part, level: int) -> list[Html]:
    """Return a part in full width."""
    return [*_heading(part, level), *_content(part, level)]


def _section(part: Part, level: int) -> Html:
    return element("section", *_open(part, level))


def _folded(part: Part, level: int) -> Html:
    """Return a folded part."""
    summary = element("summary", element(f"h{level}", part.heading))
    named = {"id": part.name} if part.name else {}
    # A link to its content opens it.
    return element("details", summary, element("div", *_content(part, level), **named))


def _heading(part: Part, level: int) -> list[Html]:
    named = {"id": part.name} if part.name else {}
    return [element(f"h{level}", part.heading, **named)] if part.heading else []


def _content(part: Part, level: int) -> list[Html]:
    blocks = [html_block(block, part.heading) for block in part.blocks]
    return [*blocks, *html_parts(part.inner, min(level + 1, 4))]


def _runs(runs: Iterable[Run]) -> list[Html | str]:
    return [_run(run) for run in runs]


def _run(run: Run) -> Html | str:
    if isinstance(run, Bold):
        return element("b", run.text)
    return element("a", run.text, href=f"#{run.part}") if isinstance(run, Link) else run


def _item(item: Item) -> Html:
    lines = [element("div", *_runs(runs), class_="below") for runs in item.below]
    looks = {"class_": item.severity} if item.severity else {}
    return element("li", *_runs(item.runs), *lines, **looks)


def _table(table: Table, heading: str) -> Html:
    head = [
        element("th", name, scope="col", role="columnheader") if name else element("td")
        for name in table.head
    ]
    # Roles, and labels for the narrow screen, where each row is a card without columns.
    labels = table.head[1:] or ("",) * max((len(row) for row in table.rows), default=0)
    rows = [
        element(
            "tr",
            element("th", _run(first), scope="row", role="rowheader"),
            *(
                element("td", _run(cell), role="cell", **({"data_label": label} if label else {}))
                for label, cell in zip(labels, cells, strict=False)
            ),
            role="row",
        )
        for first, *cells in table.rows
    ]
    parts = [element("tbody", *rows, role="rowgroup")]
    if head:
        parts.insert(0, element("thead", element("tr", *head, role="row"), role="rowgroup"))
    look = "numbers" if table.numbers else "values" if head else "facts"
    made = element("table", *parts, class_=look, role="table")
    widest = max((len(row) for row in (*table.rows, table.head)), default=0)
    if widest <= _NARROW:
        return made
    # The keyboard can reach and scroll this area.
    return element(
        "div", made, class_="wide", tabindex="0", role="region", aria_label=heading or "table"
    )
