"""Removal of an incomplete last line, left by a logger that was killed or lost power."""

import csv

from jointid.recording.readers.csv_dialect import cells_of, number_of
from jointid.recording.readers.csv_layout import Layout, is_comment

TORN = "the last line is incomplete and left out"
"""Remark in a recording's metadata."""
_COMPARED = 50  # number of lines compared with the last one
_FEW = 20  # number of lines needed to know the shortest cell
_LONGEST = 1 << 16  # characters in which these lines are searched


def without_torn_line(text: str, layout: Layout) -> str | None:
    """Return a text without its last line if this line is incomplete; otherwise None.

    A line with fewer cells than the header is incomplete. A line without a newline may be cut within its last
    cell. That cell is then not a number, or shorter than all cells above it.

    Parameters
    ----------
    text : str
    layout : Layout
        Layout of the text's table.
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
    if not expected or numbers != wanted:  # damage further left is not a cut
        return None
    shortest = min(len(row[-1]) for row in whole)
    return None if number and len(cells[-1]) >= shortest else text[:cut]
