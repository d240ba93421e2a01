"""The dialect of a .csv file: the separator of its cells, and its decimal sign."""

import csv
import re
from collections.abc import Sequence

from jointid.base.errors import InputError

_SEPARATORS = {",": "commas", ";": "semicolons", "\t": "tabs"}
BLANK = " "  # one or several blanks separate the cells of controllers' logs
_TOKEN = r'"[^"]*"|\S+'
_UNITS = r"[\[(][^\])]*[\])]|\S+"
_LONG = 10_000  # characters: brackets in longer lines are ignored
_OPEN = r"[\[(][^\[\]()]*$"
_DECIMAL_COMMA = r"(?i)[+-]?(\d+,\d*|,\d+)(e[+-]?\d+)?"
# 1,234 may mean 1234 or 1.234; 0,25 and 1,5 and 1234,567 are unambiguous.
_AMBIGUOUS = r"[+-]?[1-9]\d{0,2},\d{3}"


def cells_of(line: str, separator: str) -> list[str]:
    """Return the cells of a line, without blanks around them.

    Raises
    ------
    csv.Error
        Quotation marks do not match.
    """
    if separator == BLANK:
        return _between_blanks(line)
    if '"' not in line:
        return [cell.strip() for cell in line.split(separator)]
    return [cell.strip() for cell in next(csv.reader([line], delimiter=separator, strict=True))]


def _between_blanks(line: str) -> list[str]:
    """Return the words between blanks; a bracket belongs to the word before it: `time [s]`."""
    if len(line) > _LONG or not any(sign in line for sign in '"[('):
        return line.split()
    if line.lstrip()[:1] in ("[", "("):  # a row of units
        return re.findall(_UNITS, line)
    cells: list[str] = []
    for token in re.findall(_TOKEN, line):
        if cells and (token[0] in "[(" or re.search(_OPEN, cells[-1])):
            cells[-1] += f" {token}"
        else:
            cells.append(token.strip('"'))
    return cells


def number_of(cell: str, separator: str = ",") -> float | None:
    """Return a cell's number, parsed like numpy, or None.

    A decimal comma is accepted unless commas separate the cells.
    """
    if separator != "," and re.fullmatch(_DECIMAL_COMMA, cell):
        cell = cell.replace(",", ".")
    try:
        return float(cell) if cell.isascii() and "_" not in cell else None
    except ValueError:
        return None


def separator_named(line: str) -> str | None:
    """Return the separator that a line such as ``sep=;`` names (spreadsheets write it), or None."""
    named = re.fullmatch(r'"?sep=([,;\t])"?[,;\t]*', line.strip(" "))
    return named[1] if named else None


def separator_of(header: str, row: str, place: str) -> str:
    """Return the separator of the cells, from the first two lines.

    A separator fits if it divides both lines into the same number of cells, at least two. If several
    fit, the separator with the most numbers is chosen. If none fits, the row is damaged, and the first
    line alone decides.

    Raises
    ------
    InputError
        Several fit equally well, or none is in the first line.
    """
    fitting: dict[str, int] = {}
    for separator in _SEPARATORS:
        above, below = _cells_or_none(header, separator), _cells_or_none(row, separator)
        if above and below and len(above) == len(below) > 1:
            fitting[separator] = sum(number_of(cell, separator) is not None for cell in below)
    by_blanks = _between_blanks(row)
    numbers = sum(number_of(cell, BLANK) is not None for cell in by_blanks)
    if (
        1 < len(by_blanks) == len(_between_blanks(header))
        and (not fitting or numbers == len(by_blanks))
        and (not fitting or max(fitting.values()) < numbers)
    ):
        return BLANK
    if fitting:
        most = max(fitting.values())
        best = [separator for separator, numbers in fitting.items() if numbers == most]
        if len(best) == 1:
            return best[0]
        names = " or ".join(_SEPARATORS[separator] for separator in best)
        raise InputError(
            f"the cells may be separated by {names}",
            place=place,
            remedy="put texts that contain these characters into quotation marks",
        )
    by_header = max(_SEPARATORS, key=lambda separator: header.count(separator))
    if by_header not in header:
        if len(by_blanks) > 1 and len(_between_blanks(header)) > 1:
            return BLANK
        raise InputError(
            f"{header.strip()[:60]!r} has no separator; at least the columns time and position are expected, "
            "separated by commas, semicolons, tabs or blanks",
            place=place,
        )
    return by_header


def _cells_or_none(line: str, separator: str) -> list[str] | None:
    try:
        return cells_of(line, separator)
    except csv.Error:
        return None


def decimal_comma(columns: Sequence[Sequence[str]]) -> tuple[int, int, str] | None:
    """Return the reason why a comma in these cells is not clearly a decimal sign, or None.

    Parameters
    ----------
    columns : sequence of sequences of str
        The cells of each column, at least one of them with a comma.

    Returns
    -------
    tuple of int, int, str, or None
        Column, row and reason. Reasons are a decimal point elsewhere, or only numbers such as
        ``1,234``, which may mean 1234.
    """
    commas = points = None
    unambiguous = False
    for column, cells in enumerate(columns):
        together = "\n".join(cells)
        if commas is None and "," in together:
            commas = column, next(k for k, cell in enumerate(cells) if "," in cell)
        if points is None and "." in together:
            points = column, next(k for k, cell in enumerate(cells) if "." in cell)
        unambiguous = unambiguous or any(
            "," in cell and not re.fullmatch(_AMBIGUOUS, cell) for cell in cells
        )
    if commas is None:
        return None
    cell = columns[commas[0]][commas[1]][:40]
    if points is not None:
        other = columns[points[0]][points[1]][:40]
        both = f"{cell!r} here and {other!r} elsewhere" if cell != other else repr(cell)
        return *commas, f"the numbers contain commas and points ({both})"
    if not unambiguous:
        return *commas, f"{cell!r} may mean {cell.replace(',', '.')} or {cell.replace(',', '')}"
    return None
