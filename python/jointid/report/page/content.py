"""A page as data: parts under headings, with blocks. A renderer converts it to HTML, Markdown or text."""

from __future__ import annotations

from typing import Literal, TypeAlias

from jointid.base.values import dataclass
from jointid.panels.marks import Picture

Look = Literal["open", "half", "folded"]
"""Layout of a part: in full width, next to another half, or folded until it is opened."""


@dataclass(frozen=True, slots=True)
class Bold:
    """Emphasized words."""

    text: str


@dataclass(frozen=True, slots=True)
class Link:
    """A link to a part of the same page, by the part's name."""

    text: str
    part: str


Run: TypeAlias = str | Bold | Link
"""Words with one look."""


@dataclass(frozen=True, slots=True)
class Answer:
    """The first sentence of a page, in the colour of a level ("usable", …) if it has one."""

    sentence: str
    level: str = ""


@dataclass(frozen=True, slots=True)
class Paragraph:
    """A paragraph."""

    runs: tuple[Run, ...]
    muted: bool = False


@dataclass(frozen=True, slots=True)
class Item:
    """One line of a list, with smaller lines below it. A finding has a severity."""

    runs: tuple[Run, ...]
    below: tuple[tuple[Run, ...], ...] = ()
    severity: str = ""


@dataclass(frozen=True, slots=True)
class Items:
    """A list."""

    lines: tuple[Item, ...]


@dataclass(frozen=True, slots=True)
class Table:
    """Rows of cells. The first cell is the name of its row.

    Attributes
    ----------
    rows : tuple of tuple of Run
    head : tuple of str
        Titles of the columns. Default: none, as for pairs of a label and a text.
    numbers : bool
        Whether all cells except the first are numbers, aligned to the right. Default False.
    """

    rows: tuple[tuple[Run, ...], ...]
    head: tuple[str, ...] = ()
    numbers: bool = False


@dataclass(frozen=True, slots=True, eq=False)
class Figure:
    """A picture with its caption."""

    picture: Picture


@dataclass(frozen=True, slots=True)
class Code:
    """Lines that a reader can copy."""

    text: str


@dataclass(frozen=True, slots=True, eq=False)
class Multiples:
    """Small pictures of the same kind, two in a row if there is space."""

    pictures: tuple[Picture, ...]


Block: TypeAlias = Answer | Paragraph | Items | Table | Figure | Code | Multiples


@dataclass(frozen=True, slots=True, eq=False)
class Part:
    """Content under one heading.

    Attributes
    ----------
    heading : str
        "": the part belongs to the part before it.
    blocks : tuple of Block
    name : str
        Name for links on the page; unique. Default: none.
    look : {"open", "half", "folded"}
    inner : tuple of Part
        Parts under smaller headings, below the blocks.
    """

    heading: str
    blocks: tuple[Block, ...]
    name: str = ""
    look: Look = "open"
    inner: tuple[Part, ...] = ()


@dataclass(frozen=True, slots=True, eq=False)
class Page:
    """A whole page.

    Attributes
    ----------
    title, footer : str
    parts : tuple of Part
    """

    title: str
    parts: tuple[Part, ...]
    footer: str = ""


def pairs(rows: tuple[tuple[str, str], ...] | list[tuple[str, str]]) -> Table:
    """Return labels and texts as a table."""
    return Table(tuple((label, text) for label, text in rows))


def table_of(rows: list[list[str]] | list[tuple[str, ...]], numbers: bool = True) -> Table:
    """Return rows of text as a table. The first row is its head."""
    head, *others = rows
    return Table(tuple(tuple(row) for row in others), tuple(head), numbers)


def paragraph(text: str, muted: bool = False) -> Paragraph:
    """Return a paragraph of plain text."""
    return Paragraph((text,), muted)
