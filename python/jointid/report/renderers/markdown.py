"""Render a page as Markdown, for a notebook cell, an issue or a wiki. Captions replace pictures."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence

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

_SYNTAX = re.compile(r"([\\`*_\[\]<>|#])")


def render(shown: Page) -> str:
    """Return a page as Markdown."""
    lines = [f"# {_plain(shown.title)}", "", *_parts(shown.parts, 2)]
    if shown.footer:
        lines += [_plain(shown.footer), ""]
    return "\n".join(lines)


def _parts(parts: Sequence[Part], level: int) -> list[str]:
    lines: list[str] = []
    for part in parts:
        if part.heading:
            lines += [f"{'#' * level} {_plain(part.heading)}", ""]
        for block in part.blocks:
            lines += [*_block(block), ""]
        lines += _parts(part.inner, min(level + 1, 4))
    return lines


def _block(block: Block) -> list[str]:
    match block:
        case Answer(sentence):
            return [f"**{_plain(sentence)}**"]
        case Paragraph(runs):
            return [_runs(runs)]
        case Items(lines):
            return [
                line
                for item in lines
                for line in (
                    f"- {_runs(item.runs)}",
                    *(f"  <br>{_runs(runs)}" for runs in item.below),
                )
            ]
        case Table():
            return _table(block)
        case Figure(picture):
            return [f"*{_plain(picture.caption)}*"]
        case Code(text):
            return ["```", text, "```"]
        case Multiples(pictures):
            return [
                f"- *{_plain(picture.title)}: {_plain(picture.caption)}*" for picture in pictures
            ]


def _table(table: Table) -> list[str]:
    width = max((len(row) for row in (*table.rows, table.head)), default=0)
    head = table.head or ("",) * width
    rule = ["---:" if table.numbers and column else "---" for column in range(width)]
    rows = [[_run(cell) for cell in row] for row in table.rows]
    return [_line(map(_plain, head)), _line(rule), *map(_line, rows)]


def _line(cells: Iterable[str]) -> str:
    return f"| {' | '.join(cells)} |"


def _runs(runs: Iterable[Run]) -> str:
    return " ".join("".join(map(_run, runs)).split())


def _run(run: Run) -> str:
    if isinstance(run, Link):
        return ""  # the linked part follows
    if isinstance(run, str):
        return _escaped(run)
    # Markdown reads stars as bold only next to a letter.
    inner = run.text.strip()
    before, _, after = run.text.partition(inner)
    return f"{before}**{_escaped(inner)}**{after}"


def _plain(text: str) -> str:
    """Return a text on one line without Markdown syntax."""
    return " ".join(_escaped(text).split())


def _escaped(text: str) -> str:
    return _SYNTAX.sub(r"\\\1", text)
