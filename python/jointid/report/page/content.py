"""A page as data: parts under headings, and what stands in them. A renderer turns it into HTML, Markdown or text."""

from __future__ import annotations

from typing import Literal, TypeAlias

from jointid.base.values import dataclass
from jointid.panels.marks import Picture

Look = Literal["open", "half", "folded"]
"""How a part stands on a page: in full width, next to another half, or closed until it is wanted."""


@dataclass(frozen=True, slots=True)
class Bold:
    """Words that stand out."""

    text: str


@dataclass(frozen=True, slots=True)
class Link:
    """Words that lead to a part of the same page, by the part's name."""

    text: str
    part: str


Run: TypeAlias = str | Bold | Link
"""A stretch of words in one look."""


@dataclass(frozen=True, slots=True)
class Answer:
    """The sentence that a page begins with, in the colour of a level ("usable", …) if it has one."""

    sentence: str
    level: str = ""


@dataclass(frozen=True, slots=True)
class Paragraph:
    """Words in one paragraph."""

    runs: tuple[Run, ...]
    muted: bool = False


@dataclass(frozen=True, slots=True)
class Item:
    """One line of a list, with smaller lines below it; a finding has a severity."""

    runs: tuple[Run, ...]
    below: tuple[tuple[Run, ...], ...] = ()
    severity: str = ""


@dataclass(frozen=True, slots=True)
class Items:
    """A list."""

    lines: tuple[Item, ...]


@dataclass(frozen=True, slots=True)
class Table:
    """Rows of cells; the first cell names its row.

    Attributes
    ----------
    rows : tuple of tuple of Run
    head : tuple of str
        Default: none, as for pairs of a label and a text.
    numbers : bool
        Whether all cells but the first are numbers, which stand to the right. Default False.
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
    """Lines to copy."""

    text: str


@dataclass(frozen=True, slots=True, eq=False)
class Multiples:
    """Alike small pictures, two in a row where there is room."""

    pictures: tuple[Picture, ...]


Block: TypeAlias = Answer | Paragraph | Items | Table | Figure | Code | Multiples


@dataclass(frozen=True, slots=True, eq=False)
class Part:
    """What stands under one heading.

    Attributes
    ----------
    heading : str
        "": the part belongs to the one before it.
    blocks : tuple of Block
    name : str
        For links on the page; unique. Default: none.
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
    """Return rows of text as a table; the first is its head."""
    head, *others = rows
    return Table(tuple(tuple(row) for row in others), tuple(head), numbers)


def paragraph(text: str, muted: bool = False) -> Paragraph:
    """Return a paragraph of plain words."""
    return Paragraph((text,), muted)
