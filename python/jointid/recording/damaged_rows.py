"""Rows with a value that is no measurement: which they are, and when they may be left out."""

from collections.abc import Mapping

import numpy as np
import numpy.typing as npt

from jointid.base.advice import Action
from jointid.base.errors import InputError
from jointid.recording.plausibility import LARGEST
from jointid.recording.signals import FloatArray

_MOST = 0.1  # of the rows: more are not damaged, they are in another unit or of another meaning
NOTE = "dropped_rows"  # in a recording's metadata: how many were left out
DROP = Action("call", {"drop_invalid": True}, text="to leave such rows out", function="load")


class RepeatedHeaderError(InputError):
    """A second file was appended to a file, header and all: no row of it is damaged."""


def sound_rows(signals: Mapping[str, FloatArray]) -> npt.NDArray[np.bool_]:
    """Return which rows have only values that a joint can have: finite, and not absurdly large.

    Parameters
    ----------
    signals : mapping of str to ndarray, each of shape (n,)
        In SI.
    """
    columns = list(signals.values())
    sound = np.ones(len(columns[0]), dtype=np.bool_)
    with np.errstate(invalid="ignore"):
        for values in columns:
            sound &= np.abs(values) <= LARGEST  # false for NaN, too
    return sound


def few(sound: npt.NDArray[np.bool_]) -> bool:
    """Whether rows that are not sound are few enough to be damaged ones."""
    return bool(np.count_nonzero(~sound) <= _MOST * len(sound))


def checked_rows(sound: npt.NDArray[np.bool_], source: str) -> npt.NDArray[np.intp]:
    """Return the sound rows, or raise `InputError` where more than a tenth is not."""
    if not few(sound):
        raise InputError(
            f"{np.count_nonzero(~sound)} of {len(sound)} rows have a value that no joint has: they are not single "
            "damaged rows",
            argument="drop_invalid",
            value=True,
            place=source,
            remedy="look at the columns and their units",
        )
    return np.flatnonzero(sound)
