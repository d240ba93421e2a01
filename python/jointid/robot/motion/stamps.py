"""The clock of a robot's recording: where the host's stamps are late by chance, and the samples were even."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from jointid.recording.wide.robot_recording import RobotRecording
from jointid.robot.motion.numbering import row_numbers, share_of_stamps

Array = NDArray[np.float64]
Whole = NDArray[np.int64]

_BLOCK = 50  # samples: among so many, one stamp is hardly late
_AWAY = 1.0  # periods by which the earliest stamps may leave an even clock; lost samples leave it by more
_EVEN = 0.3  # of the stamps' scatter: so far the samples of an even clock follow it at most
_SURE = 3.0  # standard errors of that


def on_even_clock(recording: RobotRecording) -> RobotRecording:
    """Return the recording with even stamps, if its positions say that it was sampled evenly; otherwise itself.

    A host that stamps what it receives is late by another time each sample, and the derived velocities are
    wrong by as much. A lost sample leaves a jump of whole periods. Samples that were truly uneven keep their stamps.
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
    """Numbers of rows whose stamps are late by several periods; None where some are lost or the clock is uneven."""
    number = np.arange(time.size)
    step, begin = np.polyfit(number, time, 1)
    late = time - begin - step * number
    blocks = late.size // _BLOCK
    if blocks < 2:
        return None
    earliest = late[: blocks * _BLOCK].reshape(blocks, _BLOCK).min(axis=1)
    return number if np.ptp(earliest) <= _AWAY * step else None
