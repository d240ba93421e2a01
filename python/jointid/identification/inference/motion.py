"""Motion of a joint in each window, and segments of the motion."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.balance.segments import Segments, between, usual_length
from jointid.base.values import dataclass
from jointid.problem.problem import Problem
from jointid.problem.window_table import WindowTable

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True)
class Motion:
    """Motion of the joint in each window.

    Attributes
    ----------
    start, stop : ndarray, shape (windows,)
        Start and end of each window on the recording's clock [s].
    travel : ndarray, shape (windows,)
        Change of the position over each window [rad or m].
    recording : ndarray of int
        Index of each window's recording.
    """

    start: Array
    stop: Array
    travel: Array
    recording: NDArray[np.int64]

    @classmethod
    def of(cls, problem: Problem, penalty: _core.Penalty) -> Motion:
        """Return the motion in a penalty's windows."""
        bounds, run = np.asarray(penalty.windows), np.asarray(penalty.recording_of)
        start, stop, travel = np.empty((3, run.size))
        for number, recording in enumerate(problem.recordings):
            mine = slice(*np.searchsorted(run, (number, number + 1)))
            first, last = bounds[mine, 0], bounds[mine, 1]
            start[mine], stop[mine] = recording.time[first], recording.time[last]
            travel[mine] = recording.position[last] - recording.position[first]
        return cls(start=start, stop=stop, travel=travel, recording=run)

    @classmethod
    def of_table(cls, table: WindowTable) -> Motion:
        """Return the motion in the windows of a table."""
        travel = table.velocity * (table.stop - table.start)
        return cls(start=table.start, stop=table.stop, travel=travel, recording=table.recording)

    @property
    def moved(self) -> Array:
        """Duration of each window [s]."""
        return self.stop - self.start

    @property
    def segment_length(self) -> float:
        """Usual duration of a segment of this motion [s]."""
        return usual_length(float(np.sum(self.moved)))


def motion_segments(motion: Motion) -> Segments:
    """Return the segments of a motion between reversals, merged or divided to a usual duration."""
    length = motion.segment_length
    edges = first_windows_of(motion.recording)
    cuts = _core.motion_cuts(motion.start, motion.stop, motion.travel, edges, length)
    whole = np.array(cuts)
    return Segments(length=length, cuts=(whole, between(whole)))


def first_windows_of(recording: NDArray[np.int64]) -> list[int]:
    """Return the first window of each recording, followed by the number of windows."""
    count = len(recording)
    if recording[0] == recording[-1]:
        return [0, count]
    return [0, *(np.flatnonzero(np.diff(recording)) + 1).tolist(), count]
