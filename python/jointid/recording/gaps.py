"""Gaps in a recording."""

import numpy as np

from jointid.base.values import dataclass
from jointid.recording.order_statistics import median
from jointid.recording.signals import FloatArray

_LONG = 3.5  # median sample periods: three lost samples in a row make a gap, two do not


@dataclass(frozen=True, kw_only=True)
class Gap:
    """An interval between two samples that is much longer than the usual period.

    Attributes
    ----------
    index : int
        Index of the last sample before the gap.
    start : float
        Time of this sample [s].
    duration : float
        Time to the next sample [s].
    """

    index: int
    start: float
    duration: float


def find_gaps(time: FloatArray) -> tuple[Gap, ...]:
    """Return the intervals longer than 3.5 median sample periods, in order of time.

    Parameters
    ----------
    time : ndarray, shape (n,)
        Strictly increasing time stamps [s], n at least 2.
    """
    intervals = np.diff(time)
    longest = _LONG * median(intervals)
    return tuple(
        Gap(index=int(k), start=float(time[k]), duration=float(intervals[k]))
        for k in np.flatnonzero(intervals > longest)
    )
