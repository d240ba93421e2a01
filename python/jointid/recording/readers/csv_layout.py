"""Start of the table in a text file: its separator, header, row of units, and the lines above."""

import csv
from collections.abc import Sequence
from itertools import islice

from jointid.base.errors import InputError
from jointid.base.values import dataclass
from jointid.recording.headers import understood
from jointid.recording.readers.csv_dialect import (
    BLANK,
    cells_of,
    number_of,
    separator_named,
    separator_of,
)
from jointid.recording.stamps import looks_exact
from jointid.recording.units import find_unit

MARKS = ("#", "%", "//")  # of a comment
SEARCHED = 400  # lines: programs write fewer lines above a table
_SEPARATORS = (";", "\t", ",", BLANK)


@dataclass(frozen=True, kw_only=True)
class Layout:
    """The table of a text file.

    Attributes
    ----------
    separator : str
        Separator of the cells; a blank stands for any number of blanks.
    headers : tuple of str
    header_line : int
        1-based line number of the header; of the first row if there is no header.
    below : int
        0-based number of the first line that may be a row.
    bare : bool
        Whether the file has no header; the headers are then ``"column 0"``, ...
    """

    separator: str
    headers: tuple[str, ...]
    header_line: int
    below: int
    bare: bool = False


def is_comment(line: str) -> bool:
    """Whether a line is a comment: it begins with ``#``, ``%`` or ``//``."""
    return line.lstrip().startswith(MARKS)


def layout_of(lines: Sequence[str], source: str, mark: str) -> Layout:
    """Return the layout of a file's table.

    The first line that is not a comment is the header. It is the first row if it has numbers wherever the next
    line has numbers. If the next line does not fit, the first rows of numbers are searched. The header is then the
    line above them that names most signals; a row of units may be between them.

    Parameters
    ----------
    lines : sequence of str
        The first lines, or all.
    source : str
        The file, for messages.
    mark : str
        Prefix of lines that are never a header.

    Raises
    ------
    InputError
        There is no table.
    """
    each = (k for k, line in enumerate(lines) if line.strip() and not is_comment(line))
    filled = list(islice(each, 3))  # most tables begin in the first lines
    named = separator_named(lines[filled[0]]) if filled else None
    if named:
        filled = filled[1:]
    if not filled:
        raise InputError("the file has no header and no rows", place=source)
    first, second = filled[0], filled[1] if len(filled) > 1 else filled[0]
    if not named and not _fits(lines[first], lines[second]):
        found = _searched(lines, [*filled, *islice(each, SEARCHED - 3)], mark)
        if found is not None:
            return found
    place = f"{source}, line {first + 1}"
    separator = named or separator_of(lines[first], lines[second], place)
    cells = _cells(lines[first], separator, place)
    below = _safe_cells(lines[second], separator) if second != first else []
    if not _is_row(cells, below, separator):
        return Layout(
            separator=separator, headers=tuple(cells), header_line=first + 1, below=first + 1
        )
    above = next((k for k in reversed(range(first)) if lines[k].strip()), None)
    if above is not None and not lines[above].startswith(mark):
        comment = _safe_cells(lines[above].lstrip("#%/ "), separator)
        if len(comment) == len(cells):
            headers = tuple(comment)
            return Layout(separator=separator, headers=headers, header_line=above + 1, below=first)
    return _bare(separator, len(cells), first)


def _bare(separator: str, count: int, first: int) -> Layout:
    headers = tuple(f"column {k}" for k in range(count))
    return Layout(
        separator=separator, headers=headers, header_line=first + 1, below=first, bare=True
    )


def _fits(first: str, second: str) -> bool:
    """Whether a separator divides both lines into equally many cells, and the second is a row."""
    for separator in _SEPARATORS:
        above, below = _safe_cells(first, separator), _safe_cells(second, separator)
        if len(above) == len(below) > 1 and any(_number(cell, separator) for cell in below):
            return True
    return first == second


def _is_row(cells: Sequence[str], below: Sequence[str], separator: str) -> bool:
    """Whether a line is a row, not the header of the next line."""
    numbers = [number_of(cell, separator) is not None for cell in cells]
    if all(numbers):
        return True
    if len(below) != len(cells) or not any(numbers):
        return False
    return all(
        number or number_of(cell, separator) is None
        for number, cell in zip(numbers, below, strict=True)
    )


def _number(cell: str, separator: str) -> bool:
    return number_of(cell, separator) is not None or looks_exact(cell)


def _searched(lines: Sequence[str], filled: Sequence[int], mark: str) -> Layout | None:
    """Return the layout of a table that begins further down, below other lines."""
    for k in range(1, len(filled) - 1):
        rows = [lines[j] for j in filled[k : k + 3]]
        for separator in _SEPARATORS:
            counts = {len(_safe_cells(row, separator)) for row in rows}
            if len(counts) != 1 or min(counts) < 2:
                continue
            if any(sum(_number(c, separator) for c in _safe_cells(r, separator)) < 2 for r in rows):
                continue
            found = _below_headers(lines, filled[k], separator, min(counts), mark)
            if found is not None:
                return found
    return None


def _below_headers(
    lines: Sequence[str], first: int, separator: str, count: int, mark: str
) -> Layout | None:
    """Return the layout of the table with its first row in this line and its header in the lines above."""
    names: list[tuple[int, list[str]]] = []
    units: list[str] = []
    for k in reversed(range(max(0, first - SEARCHED), first)):
        text = lines[k].strip()
        if not text or lines[k].startswith(mark):
            continue
        cells = _safe_cells(text.lstrip("#%/ ") if is_comment(text) else lines[k], separator)
        if len(cells) != count or any(number_of(cell, separator) is not None for cell in cells):
            break
        if not names and not units and _are_units(cells):
            units = cells
        else:
            names.append((k, cells))
    if not names:  # a header of letters may look like units: t, m, N
        return None
    line, headers = max(
        names, key=lambda each: sum(understood(cell).meaning is not None for cell in each[1])
    )
    if units:
        headers = [
            name
            if understood(name).unit or not unit.strip("[]()- ")
            else f"{name} [{unit.strip('[]()')}]"
            for name, unit in zip(headers, units, strict=True)
        ]
    return Layout(separator=separator, headers=tuple(headers), header_line=line + 1, below=first)


def _are_units(cells: Sequence[str]) -> bool:
    stated = [cell.strip("[]() ") for cell in cells if cell.strip("[]()- ")]
    return bool(stated) and 2 * sum(find_unit(cell) is not None for cell in stated) >= len(stated)


def _cells(line: str, separator: str, place: str) -> list[str]:
    """Return the cells of a header without the dash of a list (``- q_1``)."""
    try:
        return [
            cell[2:].lstrip() if cell.startswith("- ") else cell
            for cell in cells_of(line, separator)
        ]
    except csv.Error as error:
        raise InputError(f"quotation marks do not match ({error})", place=place) from None


def _safe_cells(line: str, separator: str) -> list[str]:
    try:
        return cells_of(line, separator)
    except csv.Error:
        return []
