"""Segments of motion that the standard errors treat as independent.

The residual of an imperfect model is correlated while the joint moves in one direction: it has the sign of the motion,
and depends on position and speed. Neighbouring windows are then not independent, but motions between two reversals
nearly are. The rule is fixed in advance, and does not use the residual.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from jointid.base.values import dataclass
from jointid.recording.order_statistics import distinct

Array = NDArray[np.float64]
Whole = NDArray[np.int64]

# A segment is an eighth of the motion, so that there are enough segments. It is not shorter than the time in which an
# imperfect model's residual changes, and not longer than a usual motion between reversals.
_PARTS = 8
_SHORTEST, _LONGEST = 0.25, 1.0  # [s]
_MOST = 600  # largest number; in a recording of hours, segments are longer


@dataclass(frozen=True, slots=True, kw_only=True)
class Segments:
    """Two divisions of the windows into segments of motion.

    Attributes
    ----------
    length : float
        Target duration of a segment [s]; actual durations are 0.5 to 1.5 times this.
    cuts : tuple of ndarray of int
        First windows of the segments, then the number of windows: divided by the rule, and in the middle of
        these segments.
    """

    length: float
    cuts: tuple[Whole, Whole]


def even_segments(rows: int) -> Segments:
    """Return segments with equal numbers of windows, if the motion is unknown."""
    count = min(rows, 2 * _PARTS)
    cuts = distinct(np.linspace(0, rows, count + 1).round().astype(np.int64))
    return Segments(length=np.nan, cuts=(cuts, between(cuts)))


def time_segments(start: Array, stop: Array, piece: Whole) -> Segments:
    """Return segments of equal duration over rows in the order of time, with all joints of a stretch together.

    The residual of one joint's model also acts on its neighbours in the same stretch.
    """
    first, spans = _spans(start, stop, piece)
    length = usual_length(sum(spans))
    cuts, halves = [0], [0]
    for low, high, span in zip(first, [*first[1:], len(start)], spans, strict=True):
        count = max(1, round(span / length))
        for shift, found in ((0.0, cuts), (0.5, halves)):
            ends = start[low] + span * (np.arange(1, count) - shift) / count
            found += [int(low + each) for each in np.searchsorted(start[low:high], ends)]
            found.append(int(high))
    return Segments(length=length, cuts=(np.unique(cuts), np.unique(halves)))


def segment_length(start: Array, stop: Array, piece: Whole) -> float:
    """Return the target duration of a segment of rows in the order of time [s]."""
    return usual_length(sum(_spans(start, stop, piece)[1]))


def usual_length(motion: float) -> float:
    """Return the target duration of a segment [s] for a duration of motion [s]."""
    return min(max(motion / _PARTS, _SHORTEST), max(_LONGEST, motion / _MOST))


def between(cuts: Whole) -> Whole:
    """Return cuts in the middle of segments; half segments at the ends join their neighbours."""
    if len(cuts) <= 4:
        return cuts
    middle = (cuts[1:] + cuts[:-1]) // 2
    return distinct(np.concatenate([cuts[:1], middle[1:-1], cuts[-1:]]))


def _spans(start: Array, stop: Array, piece: Whole) -> tuple[Whole, list[float]]:
    """Return the first row of each piece, and its duration [s]."""
    first = np.flatnonzero(np.diff(piece, prepend=-1))
    spans = [
        float(stop[low:high].max() - start[low])
        for low, high in zip(first, [*first[1:], len(start)], strict=True)
    ]
    return first, spans
