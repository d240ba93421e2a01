"""The clock of a robot's recording: where the host's stamps are late by chance, and the samples were even."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.recording.wide.robot_recording import RobotRecording

Array = NDArray[np.float64]

_BLOCK = 50  # samples: among so many, one stamp is hardly late
_AWAY = 1.0  # periods by which the earliest stamps may leave an even clock; lost samples leave it by more
_EVEN = 0.3  # of the positions' scatter about the stamps: what even samples leave
_SEEN = 0.01  # periods: less jitter than this does no harm


def on_even_clock(recording: RobotRecording) -> RobotRecording:
    """Return the recording with even stamps, if its positions say that it was sampled evenly; otherwise itself.

    A host that stamps what it receives is late by another time each sample, and the derived velocities are
    wrong by as much. Samples that were truly uneven, or of which some are lost, keep their stamps.
    """
    index = np.arange(recording.samples)
    step, begin = np.polyfit(index, recording.time, 1)
    even = begin + step * index
    late = recording.time - even
    blocks = len(late) // _BLOCK
    if blocks < 2:
        return recording
    earliest = late[: blocks * _BLOCK].reshape(blocks, _BLOCK).min(axis=1)
    if np.ptp(earliest) > _AWAY * step:
        return recording
    errors = np.array([_errors(recording, column, step) for column in range(len(recording))])
    jittered = errors[:, 0] > _SEEN * step
    better = errors[:, 1] < _EVEN * errors[:, 0]
    if not np.any(jittered) or np.mean(better[jittered]) < 0.5:
        return recording
    # No sample was taken after its stamp.
    return type(recording)(**{**recording.fields(), "time": even + late.min()})


def all_on_even_clocks(recordings: Sequence[RobotRecording]) -> list[RobotRecording]:
    """Return each recording on the clock that its positions show."""
    return [on_even_clock(recording) for recording in recordings]


def _errors(recording: RobotRecording, column: int, step: float) -> tuple[float, float]:
    """Scatter of the samples' instants about the stamps, and about an even clock [s]."""
    position = np.ascontiguousarray(recording.position[:, column])
    stamped, even = _core.timing_errors(recording.time, position, step)
    return float(stamped), float(even)
