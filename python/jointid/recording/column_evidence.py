"""Evidence that a column of a foreign log is a signal: words and unit of its header, or its numbers."""

import re
from collections.abc import Sequence

import numpy as np

from jointid.base.errors import InputError
from jointid.recording.headers import plain, understood
from jointid.recording.order_statistics import median
from jointid.recording.signals import FloatArray
from jointid.recording.stamps import looks_exact
from jointid.recording.table import Table, first_cell

LIKELY = {
    "time": re.compile("time|stamp|clock|zeit"),
    "position": re.compile(
        "pos|winkel|travel|(^|_)ang|angle|(^|_)enc|encoder|(^|_)q[a-z0-9]?($|_)"
    ),
    "torque": re.compile("torq|moment(?!um)|effort|force|trq|(^|_)tau"),
    "current": re.compile("curr|strom|(^|_)(amps?|amperes?)($|_)|(^|_)iq"),
}
"""Signal → words in a header that indicate it."""
_COUNTER = re.compile(
    r"(^|_)(index|idx|frame|count|counter|seq|sequence|sample|row|id|nr|no|n|k|number|episode|run|trial|step)($|_)"
)
_ROWS = 5000
_EXAMINED = 12  # columns without headers
_EVEN = 0.2  # of the median step
_ALIKE = 0.99  # correlation of a velocity with the position's rate
_SMOOTHER = 3.0  # factor: a position is smoother than other columns by this


def speaks_for(header: str, signal: str) -> bool:
    """Whether a word of a header indicates a signal."""
    return LIKELY[signal].search(plain(header)) is not None


def last_word_for(header: str, signal: str) -> int:
    """Return the place of the last word in a header that indicates a signal; -1 if there is none."""
    return max((found.start() for found in LIKELY[signal].finditer(plain(header))), default=-1)


def is_counter(header: str) -> bool:
    """Whether a header names a count of rows, frames or runs."""
    return _COUNTER.search(plain(header)) is not None


def is_external(header: str) -> bool:
    """Whether a header names an external torque or force."""
    return re.search(r"(^|_)ext(ernal)?($|_)", plain(header)) is not None


def values_of(table: Table, index: int) -> FloatArray | None:
    """Return the first values of a column; None for text, a constant, or missing values."""
    try:
        (values,) = table.numbers([index])
    except InputError:
        return None
    values = values[:_ROWS]
    varies = len(values) > 2 and bool(np.isfinite(values).all()) and float(np.ptp(values)) > 0.0
    return values if varies else None


def shows_time(table: Table, index: int) -> bool:
    """Whether a column may be the time: it increases, and its header or its even steps indicate time."""
    if looks_exact(first_cell(table, index)):
        return True
    values = values_of(table, index)
    if values is None:
        return False
    if (
        speaks_for(table.headers[index], "time")
        or understood(table.headers[index]).unit is not None
    ):
        return bool((np.diff(values) >= 0.0).all())
    if not table.headers[index].strip() and (np.diff(values) == 1.0).all():
        return False  # a row counter, such as a data frame's index
    return not _COUNTER.search(plain(table.headers[index])) and _unevenness(values) < _EVEN


def shows_position(table: Table, index: int, time: int, velocity: int) -> bool:
    """Whether a column's rate of change equals the velocity in another column."""
    found = [values_of(table, each) for each in (index, time, velocity)]
    if any(each is None or len(each) != len(found[0]) for each in found):  # type: ignore[arg-type]
        return False
    return _is_rate(*found)  # type: ignore[arg-type]


def by_numbers(table: Table) -> dict[str, int]:
    """Return signal → column from the numbers of a table without headers; empty if there are headers.

    The time has even steps. The velocity is the position's rate of change. If there is none, the position is far
    smoother than all other columns. Numbers alone cannot show a torque.
    """
    if any(header != f"column {k}" for k, header in enumerate(table.headers)):
        return {}
    found = ((k, values_of(table, k)) for k in range(min(len(table.headers), _EXAMINED)))
    columns = {k: values for k, values in found if values is not None}
    uneven = {k: _unevenness(values) for k, values in columns.items()}
    time = min(uneven, key=lambda k: uneven[k], default=-1)
    if time < 0 or not np.isfinite(uneven[time]):
        return {}
    others = [k for k in columns if k != time and len(columns[k]) == len(columns[time])]
    for k in others:
        for other in others:
            if k != other and _is_rate(columns[k], columns[time], columns[other]):
                return {"time": time, "position": k, "velocity": other}
    smoothest = _smoothest(columns, others)
    return {} if smoothest is None else {"time": time, "position": smoothest}


def _unevenness(values: FloatArray) -> float:
    """Return the typical deviation of the steps over their median; infinite for a column that does not increase."""
    steps = np.diff(values)
    if not (steps > 0.0).all():
        return float("inf")
    usual = median(steps)
    return median(np.abs(steps - usual)) / usual


def _is_rate(position: FloatArray, time: FloatArray, velocity: FloatArray) -> bool:
    if not (np.diff(time) > 0.0).all():
        return False
    rate = np.gradient(position, time)
    return float(np.std(rate)) > 0.0 and float(np.corrcoef(rate, velocity)[0, 1]) > _ALIKE


def _smoothest(columns: dict[int, FloatArray], others: Sequence[int]) -> int | None:
    """Return the column that is far smoother than all others; None if there is none or only one column."""
    rough = {k: float(np.std(np.diff(columns[k], 2)) / np.std(columns[k])) for k in others}
    order = sorted(rough, key=lambda k: rough[k])
    if len(order) < 2 or rough[order[1]] < _SMOOTHER * rough[order[0]]:
        return None
    return order[0]
