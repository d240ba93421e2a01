"""A recording on a uniform clock."""

import itertools
import math
from typing import TYPE_CHECKING

import numpy as np

from jointid.base.errors import InputError
from jointid.recording.gaps import find_gaps
from jointid.recording.signals import SHORTEST, FloatArray

if TYPE_CHECKING:
    from jointid.recording.recording import Recording

_HELD = ("torque", "motor_torque", "current")  # what `torque_hold` speaks of
_MOST = 50_000_000  # samples: more is a slip in the unit
_ROUNDING = 1e-6  # periods by which the last sample may miss the clock and still count


def resampled(
    recording: "Recording", period: float | None, rate: float | None
) -> dict[str, FloatArray]:
    """Return the signals on a uniform clock within each gap-free stretch; see `Recording.resample`.

    Raises
    ------
    InputError
        As `Recording.resample`.
    """
    step = _step(period, rate)
    if recording.duration / step > _MOST:
        raise InputError(
            f"resample: a period of {step!r} s over {recording.duration:.6g} s would give more "
            f"than {_MOST} samples; seconds are expected"
        )
    stretches = _stretches(recording)
    clocks = [_clock(recording.time[stretch], step) for stretch in stretches]
    time = np.concatenate(clocks)
    if len(time) < SHORTEST:
        raise InputError(
            f"resample: a period of {step!r} s over {recording.duration:.6g} s leaves {len(time)} "
            f"samples; at least {SHORTEST} are needed"
        )
    _check_gaps(recording, time, step)
    signals = {"time": time}
    for name in recording.signals[1:]:
        values = getattr(recording, name)
        held = recording.torque_hold == "zoh" and name in _HELD
        take = _held if held else np.interp
        with np.errstate(all="ignore"):  # what overflows is refused by name
            signals[name] = np.concatenate(
                [
                    take(clock, recording.time[stretch], values[stretch])
                    for clock, stretch in zip(clocks, stretches, strict=True)
                ]
            )
    return signals


def _step(period: float | None, rate: float | None) -> float:
    if (period is None) == (rate is None):
        raise InputError("resample: give period= [s] or rate= [Hz], one of them")
    name, value = ("period", period) if rate is None else ("rate", rate)
    number = isinstance(value, int | float | np.number) and not isinstance(value, bool)
    step = float(value) if number else math.nan  # type: ignore[arg-type]
    if name == "rate" and step:
        step = 1.0 / step
    if not (0.0 < step < math.inf):
        unit = "s" if name == "period" else "Hz"
        raise InputError(f"resample: {name} is {value!r}; a positive number [{unit}] is expected")
    return step


def _stretches(recording: "Recording") -> list[slice]:
    edges = [0, *(gap.index + 1 for gap in recording.gaps), len(recording)]
    return list(itertools.starmap(slice, itertools.pairwise(edges)))


def _clock(time: FloatArray, step: float) -> FloatArray:
    count = math.floor((float(time[-1]) - float(time[0])) / step + _ROUNDING) + 1
    clock: FloatArray = time[0] + step * np.arange(count)
    return clock


def _held(clock: FloatArray, time: FloatArray, values: FloatArray) -> FloatArray:
    # A stamp a rounding error before a sample is that sample's.
    slack = _ROUNDING * float(clock[1] - clock[0]) if len(clock) > 1 else 0.0
    last = np.searchsorted(time, clock + slack, side="right") - 1
    held: FloatArray = values[last]
    return held


def _check_gaps(recording: "Recording", time: FloatArray, step: float) -> None:
    if not (time[1:] > time[:-1]).all():
        raise InputError(
            f"resample: a period of {step!r} s is below the resolution of time stamps near "
            f"{float(np.abs(time).max()):.6g} s; a longer one is needed"
        )
    if len(find_gaps(time)) != len(recording.gaps):
        shortest = min(recording.gaps, key=lambda gap: gap.duration)
        raise InputError(
            f"resample: with a period of {step!r} s the gap of {shortest.duration:.6g} s at "
            f"{shortest.start:.6g} s would not stand out any more; choose a shorter period, or "
            "split the recording there"
        )
