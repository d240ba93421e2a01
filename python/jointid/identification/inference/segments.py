"""Segments of motion: what the errors take as independent of each other.

The residual of an imperfect model hangs together as long as the joint moves the same way: it has the sign of the
motion, and follows position and speed. Neighbouring windows are then not independent, but what happens between two
reversals is nearly so. The rule is fixed in advance, and knows nothing of the residual.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.base.values import dataclass
from jointid.problem.problem import Problem
from jointid.problem.window_table import WindowTable
from jointid.recording.order_statistics import distinct

Array = NDArray[np.float64]
Cuts = NDArray[np.int64]

# A segment is an eighth of the motion, so that there are enough of them, but not shorter than what an imperfect
# model's residual needs to change, and not longer than a usual motion between reversals.
_PARTS = 8
_SHORTEST, _LONGEST = 0.25, 1.0  # [s]
_MOST = 600  # on a recording of hours they are longer


@dataclass(frozen=True, slots=True, kw_only=True)
class Segments:
    """The windows cut into segments of motion, in two ways.

    Attributes
    ----------
    length : float
        What a segment should last [s]; they last between half and one and a half of it.
    cuts : tuple of ndarray of int
        First windows of the segments, and at the end the number of windows: cut at reversals, and cut in the
        middle of these segments.
    """

    length: float
    cuts: tuple[Cuts, Cuts]


@dataclass(frozen=True, slots=True, kw_only=True)
class Motion:
    """How the joint moves in each window.

    Attributes
    ----------
    start, stop : ndarray, shape (windows,)
        [s], on the recording's clock.
    travel : ndarray, shape (windows,)
        [rad or m]
    recording : ndarray of int
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
        """Return the motion in windows of which a table is known."""
        travel = table.velocity * (table.stop - table.start)
        return cls(start=table.start, stop=table.stop, travel=travel, recording=table.recording)

    @property
    def moved(self) -> Array:
        """Duration of each window [s]."""
        return self.stop - self.start

    @property
    def segment_length(self) -> float:
        """What a segment of this motion should last [s]."""
        return usual_length(float(np.sum(self.moved)))


def motion_segments(motion: Motion) -> Segments:
    """Return the segments of a motion: between reversals, merged or divided to a usual length."""
    length = motion.segment_length
    edges = first_windows_of(motion.recording)
    cuts = _core.motion_cuts(motion.start, motion.stop, motion.travel, edges, length)
    whole = np.array(cuts)
    return Segments(length=length, cuts=(whole, _between(whole)))


def even_segments(rows: int) -> Segments:
    """Return segments of equal numbers of windows, where nothing is known of the motion."""
    count = min(rows, 2 * _PARTS)
    cuts = distinct(np.linspace(0, rows, count + 1).round().astype(np.int64))
    return Segments(length=np.nan, cuts=(cuts, _between(cuts)))


def usual_length(motion: float) -> float:
    """Return what a segment should last [s], of so much motion [s]."""
    return min(max(motion / _PARTS, _SHORTEST), max(_LONGEST, motion / _MOST))


def first_windows_of(recording: NDArray[np.int64]) -> list[int]:
    """Return the first window of each recording, and behind them the number of windows."""
    count = len(recording)
    if recording[0] == recording[-1]:
        return [0, count]
    return [0, *(np.flatnonzero(np.diff(recording)) + 1).tolist(), count]


def _between(cuts: Cuts) -> Cuts:
    """Cuts in the middle of segments; the halves at the ends go with their neighbours."""
    if len(cuts) <= 4:
        return cuts
    middle = (cuts[1:] + cuts[:-1]) // 2
    return distinct(np.concatenate([cuts[:1], middle[1:-1], cuts[-1:]]))
