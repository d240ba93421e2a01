"""Slices of a recording: the samples between two times, or of consecutive parts."""

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
            raise InputError("a time [s] is expected", argument=bound, value=value)
    kept = slice(
        int(np.searchsorted(time, low, side="left")), int(np.searchsorted(time, high, side="right"))
    )
    left = max(0, kept.stop - kept.start)
    if left < SHORTEST:
        raise InputError(
            f"from {low!s} s to {high!s} s there are {left} of {len(time)} samples "
            f"({_span(time)}); at least {SHORTEST} are needed",
            argument="stop" if start is None else "start",
        )
    return kept


def slices_of(time: FloatArray, parts: int | None, at: Sequence[float] | None) -> tuple[slice, ...]:
    """Return the samples of each part of a recording; see `Recording.split`."""
    if (parts is None) == (at is None):
        raise InputError(
            "either the number of parts or the times [s] between them are expected",
            argument="parts" if at is None else "at",
            value=parts if at is None else at,
        )
    edges = _edges_between(time, at) if at is not None else _even_edges(len(time), parts)
    slices = tuple(itertools.starmap(slice, itertools.pairwise(edges)))
    for number, part in enumerate(slices, start=1):
        if part.stop - part.start < SHORTEST:
            raise InputError(
                f"part {number} of {len(slices)} would have {part.stop - part.start} "
                f"of {len(time)} samples; at least {SHORTEST} are needed",
                argument="parts" if at is None else "at",
            )
    return slices


def _even_edges(length: int, parts: Any) -> list[int]:
    number = isinstance(parts, int | np.integer) and not isinstance(parts, bool)
    if not number or not 1 <= parts <= length // SHORTEST:
        raise InputError(
            f"an integer from 1 to {length // SHORTEST} is expected: the recording has {length} samples, and "
            f"each part needs at least {SHORTEST}",
            argument="parts",
            value=parts,
        )
    return [length * part // int(parts) for part in range(int(parts) + 1)]


def _edges_between(time: FloatArray, at: Any) -> list[int]:
    if isinstance(at, str) or not np.iterable(at):
        raise InputError("a list of times [s] is expected", argument="at", value=at)
    times = list(at)
    for index, value in enumerate(times):
        if not _is_time(value):
            raise InputError("a time [s] is expected", argument=f"at[{index}]", value=value)
        if not time[0] < value <= time[-1]:
            raise InputError(
                f"a time inside the recording is expected ({_span(time)})",
                argument=f"at[{index}]",
                value=float(value),
            )
        if index and not times[index - 1] < value:
            raise InputError(
                f"the times must increase, but the previous time is {times[index - 1]!s} s",
                argument=f"at[{index}]",
                value=float(value),
            )
    return [0, *np.searchsorted(time, times, side="left").tolist(), len(time)]


def _is_time(value: object) -> bool:
    number = isinstance(value, int | float | np.number) and not isinstance(value, bool)
    return number and not np.isnan(value)  # type: ignore[call-overload]


def _span(time: FloatArray) -> str:
    return f"{time[0]!s} s to {time[-1]!s} s"
