"""The raw samples of the last seconds, and samples that are not yet processed."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import ArrayLike, NDArray

from jointid.base.errors import InputError

Array = NDArray[np.float64]


class Samples:
    """A buffer of signals: new samples are added at the end, old samples are removed at the beginning.

    Parameters
    ----------
    signals : tuple of str
        Names of the signals, "time" among them; each sample has all of them.
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
        """Time of each sample [s]."""
        return self._rows[self.signals.index("time"), self._begin : self._end]

    def append(self, given: Mapping[str, Array]) -> None:
        """Add samples; all signals have the same length."""
        count = given["time"].size
        if self._end + count > self._rows.shape[1]:
            # Double the space, so that copies are rare.
            grown = np.empty((len(self.signals), max(1024, 2 * (len(self) + count))))
            grown[:, : len(self)] = self._rows[:, self._begin : self._end]
            self._rows, self._end, self._begin = grown, len(self), 0
        for row, signal in zip(self._rows, self.signals, strict=True):
            row[self._end : self._end + count] = given[signal]
        self._end += count

    def forget(self, count: int) -> None:
        """Remove the oldest samples."""
        self._begin += count

    def stretch(self, begin: int, end: int) -> dict[str, Array]:
        """Return copies of the signals from sample `begin` up to, not including, `end`."""
        part = slice(self._begin + begin, self._begin + end)
        return {
            signal: row[part].copy() for row, signal in zip(self._rows, self.signals, strict=True)
        }


def checked(given: Mapping[str, ArrayLike | None], signals: tuple[str, ...]) -> dict[str, Array]:
    """Return samples as arrays of one length, all finite.

    Raises
    ------
    InputError
        A signal is missing, unexpected, of another length or not finite.
    """
    here = {name for name, value in given.items() if value is not None}
    for name in signals:
        if name not in here:
            raise InputError(
                f"this signal is missing; every sample needs {', '.join(signals)}",
                argument=name,
                place="samples",
            )
    for name in sorted(here - set(signals)):
        raise InputError(
            f"the first samples did not have this signal; their signals were {', '.join(signals)}",
            argument=name,
            place="samples",
        )
    arrays = {name: _array(name, given[name]) for name in signals}
    count = arrays["time"].size
    for name, values in arrays.items():
        if values.ndim != 1 or values.size != count:
            raise InputError(
                f"its shape is {values.shape}, but time has {count} sample{'s' * (count != 1)}; one value per sample "
                "is expected",
                argument=name,
                place="samples",
            )
        if not np.isfinite(values).all():
            number = int(np.flatnonzero(~np.isfinite(values))[0])
            raise InputError(
                "a finite number is expected",
                argument=name,
                value=float(values[number]),
                place=f"samples, number {number}",
            )
    return arrays


def _array(name: str, value: ArrayLike | None) -> Array:
    """Return a signal's samples as an array, or refuse them."""
    try:
        return np.atleast_1d(np.asarray(value, dtype=np.float64))
    except (OverflowError, TypeError, ValueError) as error:  # raised by NumPy
        raise InputError(
            "a number or an array of numbers is expected",
            argument=name,
            value=value,
            place="samples",
        ) from error
