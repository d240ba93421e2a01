"""Which column of a foreign log may hold the torque, where no header says so."""

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
)  # what makes a torque without being proportional to one
_DIMENSIONS = ("torque", "force", "current", "voltage")
_SUPPLY = ("supply", "battery", "bus", "limit", "max", "min", "enable", "temp")
_ALIKE = 0.98  # correlation of another position, as of a reference


def torque_column(table: Table, taken: Collection[int], position: int | None) -> int | None:
    """Return the 0-based number of a column that may be proportional to the torque; None where nothing shows one.

    It changes, does not follow the position, and its header has a unit or a word of torque or current, or a word of
    a command. No duty or voltage is one, nor anything else of a log that has one.

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
    """Return whether a header's unit, or else its words, speak for a torque or a current; empty for neither."""
    unit = understood(header).unit
    if unit is not None and unit.dimension in ("torque", "force"):
        return "torque"
    if unit is not None and unit.dimension == "current":
        return "current"
    spoken = [each for each in ("torque", "current") if speaks_for(header, each)]
    # A torque current is a current, a current torque the actual one: the last word is what it is.
    return max(spoken, key=lambda each: last_word_for(header, each), default="")


def duty_column(table: Table, taken: Collection[int], position: int | None) -> int | None:
    """Return the 0-based number of a column that is the duty or voltage of a servo; None where none is.

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
    """The words of the columns that may have to do with the torque, by number."""
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
    """Whether a header is of a driver's own number, as "pwm_raw"; the same quantity as a share is plainer."""
    return "raw" in plain(table.headers[index])


def _follows(values: FloatArray, motion: FloatArray | None) -> bool:
    if motion is None or len(motion) != len(values):
        return False
    return abs(float(np.corrcoef(values, motion)[0, 1])) > _ALIKE
