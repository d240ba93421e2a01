"""Text with a separate time column for each group of channels: X,Y pairs, as recorders export them."""

import re
from collections.abc import Sequence
from itertools import pairwise

from jointid.base.values import dataclass
from jointid.recording.headers import parsed
from jointid.recording.order_statistics import median
from jointid.recording.readers.csv_dialect import number_of
from jointid.recording.stamps import looks_exact
from jointid.recording.units import find_unit

_SEPARATORS = ("\t", ";", ",")
_TIMES = ("x", "t", "time", "zeit", "timestamp", "x_value", "x_axis")
_HEADERS, _ROWS = 12, 20  # lines that are examined
_MILLISECONDS = (0.1, 100.0)  # steps that count as ms without a unit: 10 rows/s or more


@dataclass(frozen=True, kw_only=True)
class Paired:
    """Layout of a text with a separate time column for each group of channels.

    Attributes
    ----------
    separator : str
    lines : int
        Number of lines above the rows.
    names, units : tuple of str
        Name and unit of each column; a time column has no name.
    time_unit : str
        Unit of time as the header states it; empty if it states none.
    recognised : bool
        Whether the unit of time follows from the steps alone.
    """

    separator: str
    lines: int
    names: tuple[str, ...]
    units: tuple[str, ...]
    time_unit: str
    recognised: bool


def paired_columns(lines: Sequence[str]) -> Paired | None:
    """Return the layout of a text with several time columns of one name; None for any other text."""
    for separator in _SEPARATORS:
        table = [
            [cell.strip().strip('"') for cell in line.split(separator)]
            for line in lines[: _HEADERS + _ROWS]
        ]
        first = next(
            (k for k, row in enumerate(table[: _HEADERS + 1]) if _is_row(row, separator)), 0
        )
        for k in reversed(range(first)):
            if times := _times(table[k]):
                return _layout(table, first, k, times, separator)
    return None


def _is_row(cells: Sequence[str], separator: str) -> bool:
    start = cells[:2]
    return len(start) > 1 and all(number_of(cell, separator) is not None for cell in start)


def _times(cells: Sequence[str]) -> list[int]:
    """Return the time columns of a line if there are several, each followed by a channel."""
    names = [re.sub(r"_?\d+$", "", parsed(cell)[0]) for cell in cells]
    found = [k for k, name in enumerate(names) if name in _TIMES and name == names[0]]
    ends = [*found[1:], len(cells)]
    if len(found) < 2 or any(end - k < 2 for k, end in zip(found, ends, strict=True)):
        return []
    return found


def _layout(
    table: Sequence[Sequence[str]], first: int, line: int, times: Sequence[int], separator: str
) -> Paired | None:
    axes = table[line]
    channels = [k for k, cell in enumerate(axes) if cell and k not in times]
    own = [axes[k] for k in channels]
    if len(set(own)) < len(own):  # Y, Y, Y: the names are in the line above
        above = next((row for row in reversed(table[:line]) if any(row)), [])
        above = [*above, *[""] * (len(axes) - len(above))]
        own = [above[k] or (above[k - 1] if k - 1 in times else "") for k in channels]
    if not all(own) or len(set(own)) < len(own):
        return None
    below = [row for row in table[line + 1 : first] if any(row)]
    units = [*(below[0] if below else []), *[""] * len(axes)][: len(axes)]
    _, stated, _ = parsed(axes[0])
    stated = stated or find_unit(units[0].strip("[]()"))
    unit = "" if stated is None else stated.name
    if recognised := not unit and _are_milliseconds(table, first, separator):
        unit = "ms"
    if looks_exact(table[first][0]):
        unit = "ms"  # the unit of times in ScopeTable
    names = dict(zip(channels, own, strict=True))
    return Paired(
        separator=separator,
        lines=first,
        names=tuple(names.get(k, "") for k in range(len(axes))),
        units=tuple(units),
        time_unit=unit,
        recognised=recognised,
    )


def _are_milliseconds(table: Sequence[Sequence[str]], first: int, separator: str) -> bool:
    times = [number_of(row[0], separator) for row in table[first : first + _ROWS]]
    known = [each for each in times if each is not None]
    steps = [after - before for before, after in pairwise(known)]
    return bool(steps) and _MILLISECONDS[0] <= median(steps) < _MILLISECONDS[1]
