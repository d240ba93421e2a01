"""Constant delays between the signals of a recording, taken away by shifting signals in time."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from jointid.base.advice import Action
from jointid.base.errors import InputError
from jointid.recording.recording import Recording

SHIFTED = ("torque", "sensor", "velocity")
"""Signals that may be late against the position; "torque" stands for every signal of the drive."""

_DRIVE = ("torque", "motor_torque", "current")
_LONGEST = 1.0  # [s]; a longer delay is another recording


def checked_shift(shift: object) -> dict[str, float]:
    """Return delays by signal, those of zero left out.

    Parameters
    ----------
    shift : mapping of str to float
        [s]; positive: the signal is late.

    Raises
    ------
    InputError
        Not a mapping, a signal that cannot be shifted, or not a number of at most 1 s.
    """
    if not isinstance(shift, Mapping):
        raise InputError(
            "a mapping from signals to delays in seconds is expected, e.g. torque: 0.001",
            argument="shift",
            value=shift,
        )
    delays: dict[str, float] = {}
    for name, value in shift.items():
        if name not in SHIFTED:
            raise InputError(
                f"delays are those of {', '.join(SHIFTED)} against the position",
                argument="shift",
                value=name,
            )
        number = isinstance(value, int | float | np.number) and not isinstance(value, bool)
        if not number or not abs(float(value)) <= _LONGEST:
            raise InputError(
                f"a delay in seconds is expected, at most {_LONGEST:g} s",
                argument=f"shift.{name}",
                value=value,
            )
        if value != 0.0:
            delays[name] = float(value)
    return delays


def shifted(recording: Recording, delays: Mapping[str, float]) -> Recording:
    """Return a recording whose late signals are moved to the position's clock; extra signals are on it already.

    A signal is interpolated linearly between its samples, which for a held torque is the mean over the
    interval. The samples at the edges of a stretch, where a moved signal is not known, are left out.

    Parameters
    ----------
    recording : Recording
    delays : mapping of str to float
        As `checked_shift` returns it.

    Raises
    ------
    InputError
        A velocity that was derived from the position, a signal that is not there, or a delay longer than
        the recording.
    """
    if not delays:
        return recording
    for name in delays:
        _require(recording, name)
    time = recording.time
    kept = np.ones(len(time), dtype=bool)
    first = 0
    for last in (*(gap.index for gap in recording.gaps), len(time) - 1):
        stretch = slice(first, last + 1)
        for delay in delays.values():
            late = time[stretch] + delay
            kept[stretch] &= (late >= time[first]) & (late <= time[last])
        first = last + 1
    if np.count_nonzero(kept) < 8:
        raise InputError(
            "the recording is shorter than this delay", argument="shift", value=dict(delays)
        )
    moved = {}
    for name, delay in delays.items():
        for signal in _DRIVE if name == "torque" else (name,):
            if signal in recording.signals:
                moved[signal] = np.interp(time + delay, time, getattr(recording, signal))
    return recording.with_signals(rows=kept, **moved)


def _require(recording: Recording, name: str) -> None:
    if name == "velocity" and recording.velocity_derived:
        raise InputError(
            "the velocity is derived from the position and has no delay of its own",
            argument="shift",
            value=name,
            remedy="leave it out",
        )
    names = _DRIVE if name == "torque" else (name,)
    if all(getattr(recording, signal) is None for signal in names):
        raise InputError(
            "the recording has no such signal",
            argument="shift",
            value=name,
            remedy=Action("call", {"columns": {name: ...}}, function="load"),
        )
