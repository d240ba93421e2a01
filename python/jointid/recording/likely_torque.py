"""Which column of a foreign log may hold the torque, where no header says so."""

from __future__ import annotations

from collections.abc import Collection

import numpy as np

from jointid.base.errors import InputError
from jointid.recording.headers import plain, understood
from jointid.recording.signals import FloatArray
from jointid.recording.table import Table

# The words of a header, the likeliest first; the last are what makes a torque without being one.
_WORDS = (
    ("torq", "tau", "moment", "effort", "force", "trq"),
    ("curr", "amp", "strom", "iq"),
    ("duty", "pwm", "volt", "command", "cmd", "output"),
)
_DIMENSIONS = ("torque", "force", "current", "voltage")
_SUPPLY = ("supply", "battery", "bus", "limit", "max", "min", "enable", "temp")
_ALIKE = 0.98  # correlation of another position, as of a reference
_ROWS = 20_000


def torque_column(table: Table, taken: Collection[int], position: int | None) -> int | None:
    """Return the 0-based number of a column that may be proportional to the torque; None where none stands out.

    It changes, does not follow the position, and its header has a word of torque, current, duty or voltage; without
    such a word it is the only one of all columns that nobody needs.

    Parameters
    ----------
    table : Table
    taken : collection of int
        Columns that are other signals.
    position : int or None
        The column of the position, if it is known.
    """
    motion = None if position is None else _numbers(table, position)
    found: dict[int, str] = {}
    for index, header in enumerate(table.headers):
        read = understood(header)
        words = plain(header)
        other = read.unit is not None and read.unit.dimension not in _DIMENSIONS
        if index in taken or other or any(word in words for word in _SUPPLY):
            continue
        if read.meaning is not None and read.meaning.signal not in ("torque", "motor_torque"):
            continue
        values = _numbers(table, index)
        if values is not None and not _follows(values, motion):
            found[index] = words
    for group in _WORDS:
        likely = [k for k, words in found.items() if any(word in words for word in group)]
        if likely:
            return min(likely, key=lambda k: (_is_coded(table, k), k))
    return next(iter(found)) if len(found) == 1 else None


def _is_coded(table: Table, index: int) -> bool:
    """Whether a header is of a driver's own number, as "pwm_raw"; the same quantity as a share is plainer."""
    return "raw" in plain(table.headers[index])


def _numbers(table: Table, index: int) -> FloatArray | None:
    """The first values of a column that changes; None for text, a constant, or values that are missing."""
    try:
        (values,) = table.numbers([index])
    except InputError:
        return None
    values = values[:_ROWS]
    varies = len(values) > 1 and bool(np.isfinite(values).all()) and float(np.ptp(values)) > 0.0
    return values if varies else None


def _follows(values: FloatArray, motion: FloatArray | None) -> bool:
    if motion is None or len(motion) != len(values):
        return False
    return abs(float(np.corrcoef(values, motion)[0, 1])) > _ALIKE
