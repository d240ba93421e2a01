"""Removal of constant delays between the signals of a recording by time shifts."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from jointid.base.advice import Action
from jointid.base.errors import InputError
from jointid.recording.recording import Recording

SHIFTED = ("torque", "sensor", "velocity")
"""Signals that may lag behind the position; "torque" stands for all signals of the drive."""

_DRIVE = ("torque", "motor_torque", "current")
_LONGEST = 1.0  # [s]; a longer delay is an input error


def checked_shift(shift: object) -> dict[str, float]:
    """Return signal → delay, without zero delays.

    Parameters
    ----------
    shift : mapping of str to float
        Delays [s]; positive: the signal is late.

    Raises
    ------
    InputError
        The argument is not a mapping, a signal cannot be shifted, or a delay is not a number of at most 1 s.
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
                f"only the delay of these signals against the position can be removed: {', '.join(SHIFTED)}",
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
    """Return a recording with late signals moved to the position's clock; extra signals are not moved.

    Signals are interpolated linearly between samples; for a held torque this gives the mean over the
    interval. Samples at the edges of a stretch are left out if a moved signal is not known there.

    Parameters
    ----------
    recording : Recording
    delays : mapping of str to float
        Result of `checked_shift`.

    Raises
    ------
    InputError
        The velocity was derived from the position, the recording lacks a signal, or a delay is longer than
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
