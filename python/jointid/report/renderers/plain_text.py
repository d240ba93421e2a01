"""Render a page as plain text, for a terminal or a mail. Captions replace pictures."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from textwrap import wrap

from jointid.base.error_text import printable
from jointid.base.text_table import aligned
from jointid.report.page.content import (
    Answer,
    Block,
    Code,
    Figure,
    Items,
    Link,
    Multiples,
    Page,
    Paragraph,
    Part,
    Run,
    Table,
)

_COLUMNS = 100


def render(shown: Page) -> str:
    """Return a page as plain text of at most 100 columns, except for tables and code."""
    lines = [shown.title, "=" * len(shown.title), "", *_parts(shown.parts, "-")]
    if shown.footer:
        lines += [*wrap(shown.footer, _COLUMNS), ""]
    return printable("\n".join(lines))


def _parts(parts: Sequence[Part], underline: str) -> list[str]:
    lines: list[str] = []
    for part in parts:
        if part.heading:
            lines += [part.heading, underline * len(part.heading)]
        for block in part.blocks:
            lines += [*_block(block), ""]
        lines += _parts(part.inner, "~")
    return lines


def _block(block: Block) -> list[str]:
    match block:
        case Answer(sentence):
            return wrap(sentence, _COLUMNS)
        case Paragraph(runs):
            return wrap(_text(runs), _COLUMNS)
        case Items(lines):
            return [
                line
                for item in lines
                for line in (
                    *wrap(_text(item.runs), _COLUMNS, initial_indent="- ", subsequent_indent="  "),
                    *(line for runs in item.below for line in _indented(_text(runs))),
                )
            ]
        case Table(rows, head):
            cells = [[_text((cell,)) for cell in row] for row in rows]
            if head:
                return aligned([list(head), *cells])
            return aligned([["", ""], *cells])[2:] if cells else []
        case Figure(picture):
            return wrap(f"[picture: {picture.caption}]", _COLUMNS)
        case Code(text):
            return text.split("\n")
        case Multiples(pictures):
            named = ", ".join(picture.title for picture in pictures)
            return (
                wrap(f"[pictures of {named}: {pictures[0].caption}]", _COLUMNS) if pictures else []
            )


def _indented(text: str) -> list[str]:
    return wrap(text, _COLUMNS, initial_indent="    ", subsequent_indent="    ")


def _text(runs: Iterable[Run]) -> str:
    # A link's words are omitted, because the linked part follows.
    texts = (run if isinstance(run, str) else run.text for run in runs if not isinstance(run, Link))
    return " ".join("".join(texts).split())
