"""Correction of time stamps: repeated rows are removed, rounded stamps are made even again."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from jointid.base.values import dataclass
from jointid.recording.order_statistics import median
from jointid.recording.signals import SHORTEST, FloatArray

_BLOCK = 0.2  # share of the rows: more repeated rows are another run
_COARSE = 0.1  # of the period: a finer resolution does no harm
_FINE = 0.5  # of the period: a finer resolution shows a lost row
_ODD = 0.05  # share of the steps: if fewer steps differ, rows were lost
_ROUNDED = 0.55  # of the resolution: rounding moves a stamp by half of it at most
_BEYOND = 1.5  # resolutions: a step that exceeds the period by more than this is a gap
_ROUNDS = 5
_SHOWN = 50  # rows needed to show an even clock
_TICKS = 1 / 3  # share of the rows
_NANO = 1e9


@dataclass(frozen=True, kw_only=True)
class Clock:
    """The kept rows of a recording and their time.

    Attributes
    ----------
    time : ndarray, shape (n,)
        Time of the kept rows [s].
    kept : ndarray of int or None
        Numbers of the kept rows. None: all rows.
    notes : dict
        Metadata entries that describe the corrections.
    """

    time: FloatArray
    kept: npt.NDArray[np.intp] | None
    notes: dict[str, Any]


def clock_of(time: FloatArray, others: Sequence[FloatArray]) -> Clock:
    """Return the rows without repetitions, and their stamps without rounding.

    A row that repeats the stamp and all values of an earlier row is left out. Rows of zeros at the end, which the
    logger never filled, are left out too. If an even clock explains the stamps within their resolution, its times
    replace them. Repeated stamps that remain are refused later.

    Parameters
    ----------
    time : ndarray, shape (n,)
        [s].
    others : sequence of ndarray, each of shape (n,)
        The other signals.
    """
    filled = _filled(time, others)
    if filled < len(time):
        rest = clock_of(time[:filled], [each[:filled] for each in others])
        return Clock(
            time=rest.time,
            kept=np.arange(filled) if rest.kept is None else rest.kept,
            notes={**rest.notes, "empty_rows": len(time) - filled},
        )
    as_it_is = Clock(time=time, kept=None, notes={})
    if len(time) < SHORTEST or not np.isfinite(time).all():
        return as_it_is
    kept = repeats(time, others)
    if kept is not None and len(kept) < SHORTEST:
        return as_it_is
    once = time if kept is None else time[kept]
    if kept is not None and not (np.diff(once) > 0.0).all() and (even := _even(time)) is not None:
        return Clock(time=even[0], kept=None, notes=even[1])  # equal values of a joint at rest
    notes: dict[str, Any] = {} if kept is None else {"repeated_rows": len(time) - len(kept)}
    even = _even(once)
    return (
        Clock(time=once, kept=kept, notes=notes)
        if even is None
        else Clock(time=even[0], kept=kept, notes={**notes, **even[1]})
    )


def _filled(time: FloatArray, others: Sequence[FloatArray]) -> int:
    """Return the number of rows before the rows of zeros at the end."""
    empty = time == 0.0
    for each in others:
        empty &= each == 0.0
    rows = np.flatnonzero(~empty)
    return int(rows[-1]) + 1 if len(rows) else len(time)


def repeats(time: FloatArray, others: Sequence[FloatArray]) -> npt.NDArray[np.intp] | None:
    """Return the rows that do not repeat the stamp and all values of an earlier row; None if no row does."""
    return None if (np.diff(time) > 0.0).all() else _once(time, others)


def _once(time: FloatArray, others: Sequence[FloatArray]) -> npt.NDArray[np.intp] | None:
    same = np.diff(time) == 0.0
    for values in others:
        same &= np.diff(values) == 0.0
    kept = np.flatnonzero(np.concatenate([[True], ~same]))
    if not (np.diff(time[kept]) > 0.0).all():  # a whole block is repeated, not a single row
        rows = np.ascontiguousarray(np.column_stack([time, *others]))
        each = rows.view(np.dtype((np.void, rows.itemsize * rows.shape[1])))
        first = np.unique(each, return_index=True)[1]
        if len(time) - len(first) < _BLOCK * len(time):  # more repeated rows are another run
            kept = np.sort(first)
    return None if len(kept) == len(time) else kept


def _even(time: FloatArray) -> tuple[FloatArray, dict[str, Any]] | None:
    """Return the even clock from which these stamps were rounded; None if there is none, or no correction is needed."""
    steps = np.diff(time)
    if len(time) < _SHOWN or (steps < 0.0).any() or not (steps > 0.0).any():
        return None
    usual = median(steps)
    odd = np.count_nonzero(steps > (1.0 + _COARSE) * usual)
    odd += np.count_nonzero(steps < (1.0 - _COARSE) * usual)
    if (steps > 0.0).all() and odd < _ODD * len(steps):
        return None
    finest = int(np.gcd.reduce(np.rint(steps * _NANO).astype(np.int64))) / _NANO
    resolution = finest
    if np.count_nonzero(steps == 0.0) > _TICKS * len(steps):  # the clock is slower than the rows
        resolution = max(finest, median(steps[steps > 0.0]))
    gap = np.zeros(len(steps), dtype=np.bool_)
    for _ in range(_ROUNDS):
        period = float(np.mean(steps[~gap]))
        gap = steps > period + _BEYOND * resolution
    if resolution < _COARSE * period:
        return None
    number = _numbers(steps, period, resolution)
    pieces = np.split(np.arange(len(time)), np.flatnonzero(gap) + 1)
    period = _slope(time, number, pieces)
    even = np.empty_like(time)
    slack = finest * (resolution > finest)
    for rows in pieces:
        start = time[rows] - period * number[rows]
        if start.max() - start.min() > 2.0 * _ROUNDED * resolution + slack:
            return None
        even[rows] = 0.5 * (start.max() + start.min()) + period * number[rows]
    if not (np.diff(even) > 0.0).all():
        return None
    said = {"resolution": resolution, "period": period}
    return even, {"rounded_stamps": {key: float(f"{each:.9g}") for key, each in said.items()}}


def _numbers(steps: FloatArray, period: float, resolution: float) -> FloatArray:
    """Return the number of each sample. Lost samples are counted if the stamps are fine enough to show them."""
    fine = resolution < _FINE * period
    passed = np.maximum(1.0, np.rint(steps / period)) if fine else np.ones_like(steps)
    return np.concatenate([[0.0], np.cumsum(passed)])


def _slope(time: FloatArray, number: FloatArray, pieces: Sequence[npt.NDArray[np.intp]]) -> float:
    """Return the period that fits all pieces best."""
    above = below = 0.0
    for rows in pieces:
        centred = number[rows] - float(np.mean(number[rows]))
        above += float(centred @ time[rows])
        below += float(centred @ centred)
    return above / below
