"""The raw samples of the last seconds, and those not yet digested."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import ArrayLike, NDArray

from jointid.base.errors import InputError

Array = NDArray[np.float64]


class Samples:
    """Signals that grow at one end and are forgotten at the other.

    Parameters
    ----------
    signals : tuple of str
        "time" and others; each sample has all of them.
    """

    def __init__(self, signals: tuple[str, ...]) -> None:
        self.signals = signals
        self._rows: Array = np.empty((len(signals), 1024))
        self._begin = 0
        self._end = 0

    def __len__(self) -> int:
        return self._end - self._begin

    @property
    def time(self) -> Array:
        """Of each sample [s]."""
        return self._rows[self.signals.index("time"), self._begin : self._end]

    def append(self, given: Mapping[str, Array]) -> None:
        """Add samples; all signals are of one length."""
        count = given["time"].size
        if self._end + count > self._rows.shape[1]:
            # Room for as many again: copying stays cheap against what arrives.
            grown = np.empty((len(self.signals), max(1024, 2 * (len(self) + count))))
            grown[:, : len(self)] = self._rows[:, self._begin : self._end]
            self._rows, self._end, self._begin = grown, len(self), 0
        for row, signal in zip(self._rows, self.signals, strict=True):
            row[self._end : self._end + count] = given[signal]
        self._end += count

    def forget(self, count: int) -> None:
        """Drop the oldest samples."""
        self._begin += count

    def stretch(self, begin: int, end: int) -> dict[str, Array]:
        """Copies of the signals from sample `begin` up to, not including, `end`."""
        part = slice(self._begin + begin, self._begin + end)
        return {
            signal: row[part].copy() for row, signal in zip(self._rows, self.signals, strict=True)
        }


def checked(given: Mapping[str, ArrayLike | None], signals: tuple[str, ...]) -> dict[str, Array]:
    """Samples as arrays of one length, finite.

    Raises
    ------
    InputError
        A signal that is missing, too many, of another length or not finite.
    """
    here = {name for name, value in given.items() if value is not None}
    for name in signals:
        if name not in here:
            raise InputError(f"feed: '{name}' is missing; every sample needs {', '.join(signals)}")
    for name in sorted(here - set(signals)):
        raise InputError(
            f"feed: '{name}' came with these samples, but not with the first; they had {', '.join(signals)}"
        )
    try:
        arrays = {
            name: np.atleast_1d(np.asarray(given[name], dtype=np.float64)) for name in signals
        }
    except (TypeError, ValueError) as error:
        raise InputError(f"feed: a sample is not a number: {error}") from error
    count = arrays["time"].size
    for name, values in arrays.items():
        if values.ndim != 1 or values.size != count:
            raise InputError(
                f"feed: '{name}' has shape {values.shape}, 'time' has {count} sample(s); give one of each a sample"
            )
        if not np.isfinite(values).all():
            number = int(np.flatnonzero(~np.isfinite(values))[0])
            raise InputError(f"feed: '{name}' is {values[number]} at sample {number}, not a number")
    return arrays
