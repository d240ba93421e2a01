"""Reading long text files as a stream: a list of a million lines takes more time and memory than the numbers."""

import re
from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np

from jointid.recording.readers.csv_dialect import BLANK
from jointid.recording.signals import FloatArray

_BLOCK = 1 << 23  # characters


_LINE = re.compile(r"([^\r\n]*)(?:\r\n|\r|\n|\Z)")


def each_line(text: str) -> Iterator[str]:
    """Yield the lines of a text one by one, without a list; an empty line may follow the last one."""
    for match in _LINE.finditer(text):
        yield match[1]


def plain_numbers(
    source: Path | Iterator[str],
    below: int,
    separator: str,
    count: int,
    columns: Sequence[int] | None = None,
) -> FloatArray | None:
    """Return the cells below the header if all are plain numbers; otherwise None.

    The parser is the same as for short files, but it reads a stream.

    Parameters
    ----------
    source : Path or iterator of str
        A file, or the lines of one.
    below : int
        Lines above the rows.
    separator : str
    count : int
        Expected number of columns.
    columns : sequence of int, optional
        Columns to read. Default: all.
    """
    try:
        table = np.loadtxt(
            source,
            delimiter=None if separator == BLANK else separator,
            dtype=np.float64,
            comments=None,
            skiprows=below,
            usecols=columns,
            ndmin=2,
            encoding="latin-1",  # numbers are ASCII, and the header does not matter
        )
    except ValueError:
        return None
    return table if table.shape[1] == count and len(table) > 0 else None


def even_rows(text: str, below: int, separator: str, count: int) -> bool:
    """Whether every line below the header has the header's number of separators, and no line is blank.

    Parameters
    ----------
    text : str
        The whole file.
    below : int
        Lines above the rows.
    separator : str
    count : int
        Number of cells per row.
    """
    if "\r" in text and "\r\n" not in text:
        return False
    start = 0
    for _ in range(below):
        start = text.find("\n", start) + 1
    wanted = count - 1
    while start < len(text):
        end = (
            len(text)
            if start + _BLOCK >= len(text)
            else text.rfind("\n", start, start + _BLOCK) + 1
        )
        if end <= start:
            return False
        block = np.frombuffer(text[start:end].rstrip("\n").encode("utf-8"), dtype=np.uint8)
        lines = np.concatenate([[0], np.flatnonzero(block == ord("\n")) + 1])
        lines = lines[lines < len(block)]
        if not len(lines):
            return False
        cells = np.add.reduceat(block == ord(separator), lines, dtype=np.intp)
        if not (cells == wanted).all():
            return False
        start = end
    return True
