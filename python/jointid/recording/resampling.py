"""A recording on a uniform clock."""

import itertools
import math
from typing import Any

import numpy as np

from jointid.base.errors import InputError
from jointid.recording.gaps import find_gaps
from jointid.recording.samples import Samples
from jointid.recording.signals import SHORTEST, FloatArray

_HELD = ("torque", "motor_torque", "current")  # signals that `torque_hold` describes
_MOST = 50_000_000  # samples: more result from a wrong unit
_ROUNDING = 1e-6  # periods: the last sample may miss the clock by this and is still included


def resampled(recording: Samples, period: float | None, rate: float | None) -> dict[str, Any]:
    """Return all signals on a uniform clock within each gap-free stretch; see `Recording.resample`.

    Raises
    ------
    InputError
        Same errors as `Recording.resample`.
    """
    step = _step(period, rate)
    argument = "period" if rate is None else "rate"
    if recording.duration / step > _MOST:
        raise InputError(
            f"a period of {step!r} s over {recording.duration:.6g} s gives more than {_MOST} "
            "samples; state the period in seconds",
            argument=argument,
        )
    stretches = _stretches(recording)
    clocks = [_clock(recording.time[stretch], step) for stretch in stretches]
    time = np.concatenate(clocks)
    if len(time) < SHORTEST:
        raise InputError(
            f"a period of {step!r} s over {recording.duration:.6g} s gives only {len(time)} "
            f"samples; at least {SHORTEST} are needed",
            argument=argument,
        )
    _check_gaps(recording, time, step, argument)

    def taken(values: FloatArray, held: bool) -> FloatArray:
        take = _held if held else np.interp
        with np.errstate(all="ignore"):  # an overflow is refused later, by signal
            return np.concatenate(
                [
                    take(clock, recording.time[stretch], values[stretch])
                    for clock, stretch in zip(clocks, stretches, strict=True)
                ]
            )

    signals: dict[str, Any] = {"time": time}
    for name in recording.signals[1:]:
        held = recording.torque_hold == "zoh" and name in _HELD
        signals[name] = taken(getattr(recording, name), held)
    signals["extra"] = {name: taken(values, False) for name, values in recording.extra.items()}
    return signals


def _step(period: float | None, rate: float | None) -> float:
    if (period is None) == (rate is None):
        raise InputError(
            "either a period [s] or a rate [Hz] is expected", argument="period", value=period
        )
    name, value = ("period", period) if rate is None else ("rate", rate)
    number = isinstance(value, int | float | np.number) and not isinstance(value, bool)
    step = float(value) if number else math.nan  # type: ignore[arg-type]
    if name == "rate" and step:
        step = 1.0 / step
    if not (0.0 < step < math.inf):
        unit = "s" if name == "period" else "Hz"
        raise InputError(f"a positive number [{unit}] is expected", argument=name, value=value)
    return step


def _stretches(recording: Samples) -> list[slice]:
    edges = [0, *(gap.index + 1 for gap in recording.gaps), len(recording)]
    return list(itertools.starmap(slice, itertools.pairwise(edges)))


def _clock(time: FloatArray, step: float) -> FloatArray:
    count = math.floor((float(time[-1]) - float(time[0])) / step + _ROUNDING) + 1
    clock: FloatArray = time[0] + step * np.arange(count)
    return clock


def _held(clock: FloatArray, time: FloatArray, values: FloatArray) -> FloatArray:
    # A time stamp that precedes a sample by a rounding error belongs to this sample.
    slack = _ROUNDING * float(clock[1] - clock[0]) if len(clock) > 1 else 0.0
    last = np.searchsorted(time, clock + slack, side="right") - 1
    held: FloatArray = values[last]
    return held


def _check_gaps(recording: Samples, time: FloatArray, step: float, argument: str) -> None:
    if not (time[1:] > time[:-1]).all():
        raise InputError(
            f"a period of {step!r} s is below the resolution of time stamps near "
            f"{float(np.abs(time).max()):.6g} s; a longer period is needed",
            argument=argument,
        )
    if len(find_gaps(time)) != len(recording.gaps):
        shortest = min(recording.gaps, key=lambda gap: gap.duration)
        raise InputError(
            f"with a period of {step!r} s the gap of {shortest.duration:.6g} s at "
            f"{shortest.start:.6g} s is no longer recognised as a gap",
            argument=argument,
            remedy=("choose a shorter period", "split the recording there"),
        )
