"""Rows that repeat the one before because the logger was faster than the drive's bus."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.base.errors import InputError
from jointid.recording.extra import rows_of_extra
from jointid.recording.order_statistics import median
from jointid.recording.signals import SHORTEST, SIGNALS, FloatArray

_FINE = 30.0  # a usual step in smallest steps: an equal position is then no slow motion
_LONGER = 2.0  # times the usual run of copies, plus one: a longer run is a standstill
_ROUNDING = 1e-6  # of the median step
_EVEN = 0.3  # of the scatter about the stamps
_AWAY = 2.0  # periods: stamps that leave an even clock by more have lost samples
_PIECE = 20  # rows between standstills that show an even clock
_MOST = 0.8  # of the rows that get even stamps
_MEASURED = ("position", "velocity", "sensor", "link_position")
_COMMANDED = ("torque", "motor_torque", "current")


def without_copies(fields: Mapping[str, Any]) -> dict[str, Any]:
    """Return the arguments of `Recording` without the rows that repeat all measured signals of the row before.

    The first row of each run stays, because its stamp is nearest to the sample. A held torque
    (``torque_hold="zoh"``) becomes its mean until the next row that is kept. Where the positions show
    that the samples that are left were taken evenly, they get even stamps: the logger's say only when it
    looked, and without its copies their steps are of one or two of its periods.

    Parameters
    ----------
    fields : mapping
        Arguments of `Recording`, with arrays.

    Raises
    ------
    InputError
        The position is so coarse that equal rows are no copies, or too few rows are left.
    """
    time, position = fields["time"], fields["position"]
    steps = np.abs(np.diff(position))
    moved = steps[steps > 0.0]
    usual = median(moved) if len(moved) else 0.0
    clear = moved[moved > _ROUNDING * usual]
    if not len(clear) or usual < _FINE * float(clear.min()):
        raise InputError(
            "the position has so few steps that equal rows may be a slow motion",
            argument="drop_copies",
            value=True,
            remedy="leave it out",
        )
    same = np.ones(len(time) - 1, dtype=np.bool_)
    for name in _MEASURED:
        values = fields.get(name)
        if values is not None and not (name == "velocity" and fields.get("velocity_derived")):
            same &= np.diff(values) == 0.0
    copies, resting = _copies(same)
    kept = np.flatnonzero(~copies)
    if len(kept) < SHORTEST:
        raise InputError(f"{len(kept)} rows are left", argument="drop_copies", value=True)
    result = dict(fields)
    for name in SIGNALS:
        values = fields.get(name)
        if values is None:
            continue
        held = name in _COMMANDED and fields.get("torque_hold") == "zoh"
        result[name] = _means(time, values, kept) if held else values[kept]
    result["extra"] = rows_of_extra(fields.get("extra") or {}, kept)
    even, _ = _evened(result["time"], result["position"], resting[kept])
    result["time"] = even
    if fields.get("velocity_derived"):
        result["velocity"], result["velocity_derived"] = None, False
    return result


def fresh_rows(time: FloatArray, position: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return time and position of the rows that do not repeat the position before."""
    copies, _ = _copies(np.diff(position) == 0.0)
    return time[~copies], position[~copies]


def taken_evenly(time: FloatArray, position: FloatArray) -> bool:
    """Whether the samples, without their copies, fit an even clock far better than their stamps.

    Where they do not, their stamps are worse without the copies than with them.
    """
    copies, resting = _copies(np.diff(position) == 0.0)
    kept = ~copies
    if np.count_nonzero(kept) < SHORTEST:
        return False
    _, share = _evened(time[kept], position[kept], resting[kept])
    return share > _MOST


def _evened(
    time: FloatArray, position: FloatArray, resting: NDArray[np.bool_]
) -> tuple[FloatArray, float]:
    """Return stamps that are even between standstills, where the positions say so, and the share of such rows."""
    as_stamped, as_even = _core.timing_errors(time, position, median(np.diff(time)))
    if not as_even < _EVEN * as_stamped:
        return time, 0.0
    even, changed = time.copy(), 0
    edges = np.flatnonzero(np.diff(np.concatenate([[True], resting, [True]]).astype(np.int8)))
    for first, last in zip(edges[::2], edges[1::2], strict=True):
        if last - first < _PIECE:
            continue
        line = _line(time[first:last])
        away = float(np.abs(line - time[first:last]).max())
        before = even[first - 1] if first else -np.inf
        after = time[last] if last < len(time) else np.inf
        if away < _AWAY * (line[1] - line[0]) and before < line[0] and line[-1] < after:
            even[first:last] = line
            changed += last - first
    return even, float(changed / max(1, int(np.count_nonzero(~resting))))


def _line(time: FloatArray) -> FloatArray:
    """Even stamps nearest to these."""
    number = np.arange(len(time)) - 0.5 * (len(time) - 1)
    middle = float(np.mean(time))
    period = float(np.sum(number * (time - middle)) / np.sum(number * number))
    return np.asarray(middle + number * period)


def _copies(same: NDArray[np.bool_]) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """Whether each row is a copy of the one before, and whether it belongs to a standstill."""
    copy = np.concatenate([[False], same])
    resting = np.zeros(len(copy), dtype=np.bool_)
    edges = np.flatnonzero(np.diff(np.concatenate([copy, [False]]).astype(np.int8)))
    first, last = edges[::2] + 1, edges[1::2] + 1
    if len(first):
        longest = 1.0 + _LONGER * median(last - first)
        for start, stop in zip(first, last, strict=True):
            if stop - start > longest:
                copy[start:stop] = False
                resting[start - 1 : stop] = True
    return copy, resting


def _means(time: FloatArray, values: FloatArray, kept: NDArray[np.intp]) -> FloatArray:
    """Return the mean of a held signal from each kept row to the next; of the last row its value."""
    impulse = np.concatenate([[0.0], np.cumsum(values[:-1] * np.diff(time))])
    means = values[kept].copy()
    means[:-1] = np.diff(impulse[kept]) / np.diff(time[kept])
    # A row without copies keeps its value to the bit.
    alone = np.diff(kept) == 1
    means[:-1][alone] = values[kept[:-1]][alone]
    return np.asarray(means)
