"""Removal of rows that repeat the previous row because the logger was faster than the drive's bus."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.base.errors import InputError
from jointid.recording.extra import rows_of_extra
from jointid.recording.order_statistics import median
from jointid.recording.recording import Recording
from jointid.recording.signals import SHORTEST, SIGNALS, FloatArray

_FINE = 30.0  # median step in encoder counts: with larger steps an equal position is no slow motion
_LONGER = 2.0  # times the median run of copies, plus one: a longer run is a standstill
_ROUNDING = 1e-6  # of the median step
_EVEN = 0.3  # of the scatter about the stamps
_AWAY = 2.0  # periods: a larger deviation from an even clock means lost samples
_PIECE = 20  # rows between standstills, needed to show an even clock
HELD = 0.03  # share of the moving rows: fewer copies stay in the recording
_MOVED = 2.0  # encoder counts
_AFTER = 0.3  # of the median step
_TIMED = 0.1  # periods: largest deviation of the stamps from the sampling times
_MEASURED = ("position", "velocity", "sensor", "link_position")
_COMMANDED = ("torque", "motor_torque", "current")


def without_copies(fields: Mapping[str, Any]) -> dict[str, Any]:
    """Return the arguments of `Recording` without the rows that repeat all measured signals of the row before.

    The first row of each run stays, because its stamp is nearest to the sample. A held torque
    (``torque_hold="zoh"``) becomes its mean until the next kept row. If the positions show evenly taken
    samples, the kept rows get even stamps: the logger's stamps are polling times, and without the copies
    their steps are one or two logger periods.

    Parameters
    ----------
    fields : mapping
        Arguments of `Recording`, with arrays.

    Raises
    ------
    InputError
        The position is so coarse that equal rows may be a slow motion, or too few rows are left.
    """
    time, position = fields["time"], fields["position"]
    steps = np.abs(np.diff(position))
    moved = steps[steps > 0.0]
    usual = median(moved) if len(moved) else 0.0
    clear = moved[moved > _ROUNDING * usual]
    if not len(clear) or usual < _FINE * float(clear.min()):
        raise InputError(
            "the resolution of the position is too coarse: equal rows may be slow motion",
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
    return _fields_of(fields, kept, resting)


def without_held_rows(run: Recording) -> tuple[Recording, float] | None:
    """Return a recording without the rows that hold the previous sample, and the number of rows per sample.

    None if equal rows may be a slow motion. They are copies with a fine encoder, or, with a coarse one, if the
    recorded velocity shows that the joint moved by two encoder counts meanwhile.
    """
    same = np.diff(run.position) == 0.0
    if not same.any():
        return None
    repeated = same & (np.diff(run.velocity) == 0.0)
    if not run.velocity_derived and np.count_nonzero(repeated) > 0.5 * np.count_nonzero(same):
        same = repeated  # one sample holds both torque and motion
    copies, resting = _copies(same)
    count, moving = int(np.count_nonzero(copies)), int(np.count_nonzero(~resting))
    if count <= HELD * moving or not _is_held(run, copies):
        return None
    rows = moving / (moving - count)
    # A standstill keeps the clock of the samples around it.
    place = np.arange(len(copies)) - np.maximum.accumulate(
        np.where(resting, 0, np.arange(len(copies)))
    )
    kept = np.flatnonzero(~copies & ~(resting & (place % max(1, round(rows)) != 0)))
    if len(kept) < SHORTEST:
        return None
    reduced = Recording(**_fields_of(run._fields(), kept, resting))
    period = reduced.sample_period
    # A bus with its own clock lost samples: without the copies the stamps are worse than with them.
    timed = _core.timing_errors(reduced.time, reduced.position, period)[0] < _TIMED * period
    return (reduced, rows) if timed else None


def _is_held(run: Recording, copies: NDArray[np.bool_]) -> bool:
    """Whether equal positions are copies, not slow motion or sticking.

    After copies, the step is as large as any other step; after sticking it is smaller. The median step is many
    encoder counts, or the recorded velocity shows that the joint moved meanwhile.
    """
    steps = np.abs(np.diff(run.position))
    moved = steps[steps > 0.0]
    usual = median(moved) if len(moved) else 0.0
    clear = moved[moved > _ROUNDING * usual]
    after = steps[1:][copies[1:-1] & ~copies[2:]]
    if not len(clear) or not len(after) or median(after) < _AFTER * usual:
        return False
    quantum = float(clear.min())
    if usual >= _FINE * quantum:
        return True
    if run.velocity_derived:
        return False
    distance = np.abs(run.velocity[1:]) * np.diff(run.time)
    # For each run of copies: the distance from the velocity while the position stays.
    number = np.cumsum(~copies)[1:][copies[1:]]
    distances = np.bincount(number, weights=distance[copies[1:]])
    return bool(distances.any() and median(distances[distances > 0.0]) > _MOVED * quantum)


def _fields_of(
    fields: Mapping[str, Any], kept: NDArray[np.intp], resting: NDArray[np.bool_]
) -> dict[str, Any]:
    """Return the arguments of a recording of the kept rows, with even stamps if the positions show them."""
    time = fields["time"]
    result = dict(fields)
    for name in SIGNALS:
        values = fields.get(name)
        if values is None:
            continue
        held = name in _COMMANDED and fields.get("torque_hold") == "zoh"
        result[name] = _means(time, values, kept) if held else values[kept]
    result["extra"] = rows_of_extra(fields.get("extra") or {}, kept)
    result["time"] = _evened(result["time"], result["position"], resting[kept])
    if fields.get("velocity_derived"):
        result["velocity"], result["velocity_derived"] = None, False
    return result


def fresh_rows(time: FloatArray, position: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return time and position of the rows that do not repeat the previous position."""
    copies, _ = _copies(np.diff(position) == 0.0)
    return time[~copies], position[~copies]


def _evened(time: FloatArray, position: FloatArray, resting: NDArray[np.bool_]) -> FloatArray:
    """Return stamps that are even between standstills, if the positions show even sampling."""
    as_stamped, as_even = _core.timing_errors(time, position, median(np.diff(time)))
    if not as_even < _EVEN * as_stamped:
        return time
    even = time.copy()
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
    return even


def _line(time: FloatArray) -> FloatArray:
    """Return the even stamps nearest to these."""
    number = np.arange(len(time)) - 0.5 * (len(time) - 1)
    middle = float(np.mean(time))
    period = float(np.sum(number * (time - middle)) / np.sum(number * number))
    return np.asarray(middle + number * period)


def _copies(same: NDArray[np.bool_]) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """Return for each row whether it copies the previous one, and whether it belongs to a standstill."""
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
    """Return the mean of a held signal from each kept row to the next; for the last row its value."""
    impulse = np.concatenate([[0.0], np.cumsum(values[:-1] * np.diff(time))])
    means = values[kept].copy()
    means[:-1] = np.diff(impulse[kept]) / np.diff(time[kept])
    # A row without copies keeps its value, bit for bit.
    alone = np.diff(kept) == 1
    means[:-1][alone] = values[kept[:-1]][alone]
    return np.asarray(means)
