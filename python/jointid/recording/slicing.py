"""Parts of a recording: which samples lie between two times, or in each of several parts."""

import itertools
from collections.abc import Sequence
from typing import Any

import numpy as np

from jointid.base.errors import InputError
from jointid.recording.signals import SHORTEST, FloatArray


def slice_between(time: FloatArray, start: float | None, stop: float | None) -> slice:
    """Return the samples from one time to another, both included; see `Recording.crop`."""
    low = float(time[0]) if start is None else start
    high = float(time[-1]) if stop is None else stop
    for bound, value in (("start", low), ("stop", high)):
        if not _is_time(value):
            raise InputError(f"crop: {bound} is {value!r}; a time [s] is expected")
    kept = slice(
        int(np.searchsorted(time, low, side="left")), int(np.searchsorted(time, high, side="right"))
    )
    left = max(0, kept.stop - kept.start)
    if left < SHORTEST:
        raise InputError(
            f"crop from {low!s} s to {high!s} s leaves {left} samples of {len(time)} "
            f"({_span(time)}); at least {SHORTEST} are needed"
        )
    return kept


def slices_of(time: FloatArray, parts: int | None, at: Sequence[float] | None) -> tuple[slice, ...]:
    """Return the samples of each part of a recording; see `Recording.split`."""
    if (parts is None) == (at is None):
        raise InputError("split: give parts=, how many, or at=, the times [s] between them")
    edges = _edges_between(time, at) if at is not None else _even_edges(len(time), parts)
    slices = tuple(itertools.starmap(slice, itertools.pairwise(edges)))
    for number, part in enumerate(slices, start=1):
        if part.stop - part.start < SHORTEST:
            raise InputError(
                f"split: part {number} of {len(slices)} would have {part.stop - part.start} "
                f"samples of {len(time)}; at least {SHORTEST} are needed"
            )
    return slices


def _even_edges(length: int, parts: Any) -> list[int]:
    number = isinstance(parts, int | np.integer) and not isinstance(parts, bool)
    if not number or not 1 <= parts <= length // SHORTEST:
        raise InputError(
            f"split: parts is {parts!r}; a whole number from 1 to {length // SHORTEST} is "
            f"expected, for each of {length} samples' parts needs at least {SHORTEST}"
        )
    return [length * part // int(parts) for part in range(int(parts) + 1)]


def _edges_between(time: FloatArray, at: Any) -> list[int]:
    if isinstance(at, str) or not np.iterable(at):
        raise InputError(f"split: at is {at!r}; a list of times [s] is expected")
    times = list(at)
    for index, value in enumerate(times):
        if not _is_time(value):
            raise InputError(f"split: at[{index}] is {value!r}; a time [s] is expected")
        if not time[0] < value <= time[-1]:
            raise InputError(
                f"split: at[{index}] is {value!s} s, not inside the recording ({_span(time)})"
            )
        if index and not times[index - 1] < value:
            raise InputError(
                f"split: at[{index}] is {value!s} s after {times[index - 1]!s} s; "
                "the times must increase"
            )
    return [0, *np.searchsorted(time, times, side="left").tolist(), len(time)]


def _is_time(value: object) -> bool:
    number = isinstance(value, int | float | np.number) and not isinstance(value, bool)
    return number and not np.isnan(value)  # type: ignore[call-overload]


def _span(time: FloatArray) -> str:
    return f"{time[0]!s} s to {time[-1]!s} s"
