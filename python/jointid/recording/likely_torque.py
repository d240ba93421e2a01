"""Search for the torque's column in a foreign log, if no header names it."""

from __future__ import annotations

from collections.abc import Collection

import numpy as np

from jointid.recording.column_evidence import last_word_for, speaks_for, values_of
from jointid.recording.headers import plain, understood
from jointid.recording.signals import FloatArray
from jointid.recording.table import Table

_COMMAND = ("command", "cmd", "output")
_DUTY = (
    "duty",
    "pwm",
    "volt",
    "present_load",
)  # words of quantities that cause a torque but are not proportional to it
_DIMENSIONS = ("torque", "force", "current", "voltage")
_SUPPLY = ("supply", "battery", "bus", "limit", "max", "min", "enable", "temp")
_ALIKE = 0.98  # correlation of another position, as of a reference


def torque_column(table: Table, taken: Collection[int], position: int | None) -> int | None:
    """Return the 0-based number of a column that may be proportional to the torque; None if nothing indicates one.

    The column changes and does not follow the position. Its header has a unit or word of torque or current, or a word
    of a command. A duty or voltage is not accepted. In a log with a duty or voltage, a command is not accepted either.

    Parameters
    ----------
    table : Table
    taken : collection of int
        Columns that are other signals.
    position : int or None
        The column of the position, if it is known.
    """
    found = _candidates(table, taken, position)
    for signal in ("torque", "current"):
        likely = [k for k in found if quantity_of(table.headers[k]) == signal]
        if likely:
            return min(likely, key=lambda k: (_is_coded(table, k), k))
    if _likeliest(table, found, _DUTY) is not None:
        return None
    return _likeliest(table, found, _COMMAND)


def quantity_of(header: str) -> str:
    """Return "torque" or "current" if a header's unit, or without a unit its words, indicate one; otherwise ""."""
    unit = understood(header).unit
    if unit is not None and unit.dimension in ("torque", "force"):
        return "torque"
    if unit is not None and unit.dimension == "current":
        return "current"
    spoken = [each for each in ("torque", "current") if speaks_for(header, each)]
    # "torque current" is a current, "current torque" a torque: the last word decides.
    return max(spoken, key=lambda each: last_word_for(header, each), default="")


def duty_column(table: Table, taken: Collection[int], position: int | None) -> int | None:
    """Return the 0-based number of the column of a servo's duty or voltage; None if there is none.

    Parameters
    ----------
    table : Table
    taken : collection of int
        Columns that are other signals.
    position : int or None
        The column of the position, if it is known.
    """
    return _likeliest(table, _candidates(table, taken, position), _DUTY)


def _candidates(table: Table, taken: Collection[int], position: int | None) -> dict[int, str]:
    """Return column number → words of its header, for columns that may be related to the torque."""
    motion = None if position is None else values_of(table, position)
    found: dict[int, str] = {}
    for index, header in enumerate(table.headers):
        read = understood(header)
        words = plain(header)
        other = read.unit is not None and read.unit.dimension not in _DIMENSIONS
        if index in taken or other or any(word in words for word in _SUPPLY):
            continue
        if read.meaning is not None and read.meaning.signal not in ("torque", "motor_torque"):
            continue
        values = values_of(table, index)
        if values is not None and not _follows(values, motion):
            found[index] = words
    return found


def _likeliest(table: Table, found: dict[int, str], group: tuple[str, ...]) -> int | None:
    likely = [k for k, words in found.items() if any(word in words for word in group)]
    return min(likely, key=lambda k: (_is_coded(table, k), k)) if likely else None


def _is_coded(table: Table, index: int) -> bool:
    """Whether a header names a driver's raw number, such as "pwm_raw"; the same quantity as a ratio is preferred."""
    return "raw" in plain(table.headers[index])


def _follows(values: FloatArray, motion: FloatArray | None) -> bool:
    if motion is None or len(motion) != len(values):
        return False
    return abs(float(np.corrcoef(values, motion)[0, 1])) > _ALIKE
