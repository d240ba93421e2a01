"""A last line that a logger did not finish, because it was killed or the power failed."""

import csv

from jointid.recording.readers.csv_dialect import cells_of, number_of
from jointid.recording.readers.csv_layout import Layout, is_comment

TORN = "the last line is incomplete and left out"
"""What a recording's metadata say of it."""
_COMPARED = 50  # lines before the last one
_FEW = 20  # lines that show how short a cell may be
_LONGEST = 1 << 16  # characters in which these are looked for


def without_torn_line(text: str, layout: Layout) -> str | None:
    """Return a text without its last line if that is cut; None if it is not.

    A line is cut that has fewer cells than the header. One without a newline may be cut within its last cell: that
    is then no number, or shorter than each of those above it.

    Parameters
    ----------
    text : str
    layout : Layout
        Layout of its table.
    """
    ended = text.rstrip("\r\n \t") if layout.separator != "\t" else text.rstrip("\r\n")
    cut = max(ended.rfind("\n"), ended.rfind("\r")) + 1
    last = text[cut:]
    above = text[max(0, cut - _LONGEST) : cut].splitlines()[-_COMPARED - 1 :]
    rows = [line for line in above[1:] if line.strip() and not is_comment(line)]
    if not rows or is_comment(last) or text.count("\n", 0, cut) < layout.below:
        return None
    try:
        cells = cells_of(last.strip("\r\n"), layout.separator)
        whole = [
            found
            for row in rows
            if len(found := cells_of(row, layout.separator)) == len(layout.headers)
        ]
    except csv.Error:
        return None
    if not whole or len(cells) > len(layout.headers):
        return None
    if len(cells) < len(layout.headers):
        return text[:cut]
    if last.endswith(("\n", "\r")) or len(whole) < _FEW:
        return None
    *numbers, number = (number_of(cell, layout.separator) is not None for cell in cells)
    *wanted, expected = (number_of(cell, layout.separator) is not None for cell in whole[-1])
    if not expected or numbers != wanted:  # what is damaged further left was not cut
        return None
    shortest = min(len(row[-1]) for row in whole)
    return None if number and len(cells[-1]) >= shortest else text[:cut]
