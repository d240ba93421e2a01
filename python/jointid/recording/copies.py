"""Rows that repeat the one before because the logger was faster than the drive's bus."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.base.errors import InputError
from jointid.recording.signals import SHORTEST, SIGNALS, FloatArray

_FINE = 30.0  # a usual step in smallest steps: an equal position is then no slow motion
_LONGEST = 10  # rows: a longer run is a standstill
_ROUNDING = 1e-6  # of the median step
_EVEN = 0.3  # of the scatter about the stamps
_AWAY = 4.0  # periods: stamps that leave an even clock by more have lost samples
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
    usual = float(np.median(moved)) if len(moved) else 0.0
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
    kept = np.flatnonzero(~_short_runs(same))
    if len(kept) < SHORTEST:
        raise InputError(f"{len(kept)} rows are left", argument="drop_copies", value=True)
    result = dict(fields)
    for name in SIGNALS:
        values = fields.get(name)
        if values is None:
            continue
        held = name in _COMMANDED and fields.get("torque_hold") == "zoh"
        result[name] = _means(time, values, kept) if held else values[kept]
    if taken_evenly(result["time"], result["position"]):
        result["time"] = _line(result["time"])
    if fields.get("velocity_derived"):
        result["velocity"], result["velocity_derived"] = None, False
    return result


def fresh_rows(time: FloatArray, position: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return time and position of the rows that do not repeat the position before."""
    new = ~_short_runs(np.diff(position) == 0.0)
    return time[new], position[new]


def taken_evenly(time: FloatArray, position: FloatArray) -> bool:
    """Whether the positions fit an even clock far better than their stamps, and no sample is lost."""
    if len(time) < SHORTEST:
        return False
    as_stamped, as_even = _core.timing_errors(time, position, float(np.median(np.diff(time))))
    line = _line(time)
    away = float(np.abs(time - line).max())
    return as_even < _EVEN * as_stamped and away < _AWAY * (line[1] - line[0])


def _line(time: FloatArray) -> FloatArray:
    """Even stamps nearest to these."""
    number = np.arange(len(time)) - 0.5 * (len(time) - 1)
    middle = float(np.mean(time))
    period = float(np.sum(number * (time - middle)) / np.sum(number * number))
    return np.asarray(middle + number * period)


def _short_runs(same: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Whether each row belongs to a run of equal rows, after its first, that is no standstill."""
    copy = np.concatenate([[False], same])
    edges = np.flatnonzero(np.diff(np.concatenate([copy, [False]]).astype(np.int8)))
    for first, last in zip(edges[::2] + 1, edges[1::2] + 1, strict=True):
        if last - first > _LONGEST:
            copy[first:last] = False
    return copy


def _means(time: FloatArray, values: FloatArray, kept: NDArray[np.intp]) -> FloatArray:
    """Return the mean of a held signal from each kept row to the next; of the last row its value."""
    impulse = np.concatenate([[0.0], np.cumsum(values[:-1] * np.diff(time))])
    means = values[kept].copy()
    means[:-1] = np.diff(impulse[kept]) / np.diff(time[kept])
    # A row without copies keeps its value to the bit.
    alone = np.diff(kept) == 1
    means[:-1][alone] = values[kept[:-1]][alone]
    return np.asarray(means)
