"""The clock of a robot's recording: detect an even clock if the host's stamps are late by chance."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from jointid.recording.wide.robot_recording import RobotRecording
from jointid.robot.motion.numbering import row_numbers, share_of_stamps

Array = NDArray[np.float64]
Whole = NDArray[np.int64]

_BLOCK = 50  # samples: in such a block, at least one stamp is nearly punctual
_AWAY = 1.0  # periods by which the earliest stamps may deviate from an even clock; lost samples cause more
_EVEN = 0.3  # of the stamps' scatter: samples of an even clock follow it at most by this share
_SURE = 3.0  # standard errors of that share


def on_even_clock(recording: RobotRecording) -> RobotRecording:
    """Return the recording with even stamps if its positions show an even clock; otherwise return it unchanged.

    A host that stamps received samples has a different delay at each sample, and derived velocities get the same
    relative error. A lost sample leaves a jump of whole periods. Samples that were truly uneven keep their stamps.
    """
    number = row_numbers(recording.time, recording.position)
    if number is None:
        number = _numbers_without_loss(recording.time)
    if number is None:
        return recording
    share, error = share_of_stamps(recording.time, number, recording.position)
    if share + _SURE * error > _EVEN:
        return recording
    step, begin = np.polyfit(number, recording.time, 1)
    even = begin + step * number
    # No sample was taken after its stamp.
    return type(recording)(**{**recording.fields(), "time": even + (recording.time - even).min()})


def all_on_even_clocks(recordings: Sequence[RobotRecording]) -> list[RobotRecording]:
    """Return each recording on the clock that its positions show."""
    return [on_even_clock(recording) for recording in recordings]


def _numbers_without_loss(time: Array) -> Whole | None:
    """Return numbers of rows with stamps late by several periods; None if rows are lost or the clock is uneven."""
    number = np.arange(time.size)
    step, begin = np.polyfit(number, time, 1)
    late = time - begin - step * number
    blocks = late.size // _BLOCK
    if blocks < 2:
        return None
    earliest = late[: blocks * _BLOCK].reshape(blocks, _BLOCK).min(axis=1)
    return number if np.ptp(earliest) <= _AWAY * step else None
