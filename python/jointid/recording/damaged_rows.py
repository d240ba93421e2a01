"""Damaged rows: how they are found, and when they may be left out."""

from collections.abc import Mapping

import numpy as np
import numpy.typing as npt

from jointid.base.advice import Action
from jointid.base.errors import InputError
from jointid.recording.plausibility import LARGEST
from jointid.recording.signals import FloatArray

_MOST = 0.1  # share of the rows: if more look damaged, the column's unit or meaning is wrong
NOTE = "dropped_rows"  # metadata key: number of rows left out
DROP = Action("call", {"drop_invalid": True}, text="to leave damaged rows out", function="load")


class RepeatedHeaderError(InputError):
    """A second file with its header was appended to the file: its rows are not damaged."""


def sound_rows(signals: Mapping[str, FloatArray]) -> npt.NDArray[np.bool_]:
    """Return a mask of the rows with plausible values only: finite, and not absurdly large.

    Parameters
    ----------
    signals : mapping of str to ndarray, each of shape (n,)
        Signals in SI units.
    """
    columns = list(signals.values())
    sound = np.ones(len(columns[0]), dtype=np.bool_)
    with np.errstate(invalid="ignore"):
        for values in columns:
            sound &= np.abs(values) <= LARGEST  # false for NaN, too
    return sound


def few(sound: npt.NDArray[np.bool_]) -> bool:
    """Whether the rows outside the mask are few enough to be damaged rows."""
    return bool(np.count_nonzero(~sound) <= _MOST * len(sound))


def checked_rows(sound: npt.NDArray[np.bool_], source: str) -> npt.NDArray[np.intp]:
    """Return the numbers of the sound rows, or raise `InputError` if more than a tenth is damaged."""
    if not few(sound):
        raise InputError(
            f"{np.count_nonzero(~sound)} of {len(sound)} rows have a value that is impossible for a joint; at most "
            "a tenth of the rows can be left out",
            argument="drop_invalid",
            value=True,
            place=source,
            remedy="check the columns and their units",
        )
    return np.flatnonzero(sound)
