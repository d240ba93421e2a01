"""Segments of motion: what the errors take as independent of each other.

The residual of an imperfect model hangs together as long as the joint moves the same way: it has the sign of the
motion, and follows position and speed. Neighbouring windows are then not independent, but what happens between two
reversals is nearly so. The rule is fixed in advance, and knows nothing of the residual.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from jointid.base.values import dataclass
from jointid.recording.order_statistics import distinct

Array = NDArray[np.float64]
Whole = NDArray[np.int64]

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
        First windows of the segments, and at the end the number of windows: cut by the rule, and cut in the
        middle of these segments.
    """

    length: float
    cuts: tuple[Whole, Whole]


def even_segments(rows: int) -> Segments:
    """Return segments of equal numbers of windows, where nothing is known of the motion."""
    count = min(rows, 2 * _PARTS)
    cuts = distinct(np.linspace(0, rows, count + 1).round().astype(np.int64))
    return Segments(length=np.nan, cuts=(cuts, between(cuts)))


def time_segments(start: Array, stop: Array, piece: Whole) -> Segments:
    """Return segments of equal duration over rows in the order of time: all joints of a stretch are one.

    What one joint's model misses acts on its neighbours in the same stretch.
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
    """Return what a segment of rows in the order of time should last [s]."""
    return usual_length(sum(_spans(start, stop, piece)[1]))


def usual_length(motion: float) -> float:
    """Return what a segment should last [s], of so much motion [s]."""
    return min(max(motion / _PARTS, _SHORTEST), max(_LONGEST, motion / _MOST))


def between(cuts: Whole) -> Whole:
    """Return cuts in the middle of segments; the halves at the ends go with their neighbours."""
    if len(cuts) <= 4:
        return cuts
    middle = (cuts[1:] + cuts[:-1]) // 2
    return distinct(np.concatenate([cuts[:1], middle[1:-1], cuts[-1:]]))


def _spans(start: Array, stop: Array, piece: Whole) -> tuple[Whole, list[float]]:
    """First row of each piece, and how long each lasts [s]."""
    first = np.flatnonzero(np.diff(piece, prepend=-1))
    spans = [
        float(stop[low:high].max() - start[low])
        for low, high in zip(first, [*first[1:], len(start)], strict=True)
    ]
    return first, spans
