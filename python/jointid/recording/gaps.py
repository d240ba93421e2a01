"""Gaps in a recording, and the velocity derived within each stretch between them."""

import itertools
from dataclasses import dataclass

import numpy as np

from jointid.base.errors import InputError
from jointid.recording.signals import FloatArray

_LONG = 3.5  # median sample periods: two lost samples in a row make no gap, three do


@dataclass(frozen=True, kw_only=True)
class Gap:
    """An interval between two samples that is much longer than the others.

    Attributes
    ----------
    index : int
        The last sample before the gap.
    start : float
        Its time [s].
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
    longest = _LONG * float(np.median(intervals))
    return tuple(
        Gap(index=int(k), start=float(time[k]), duration=float(intervals[k]))
        for k in np.flatnonzero(intervals > longest)
    )


def derived_velocity(time: FloatArray, position: FloatArray, gaps: tuple[Gap, ...]) -> FloatArray:
    """Return the velocity by second-order differences on the true time stamps.

    Central differences inside a gap-free stretch, one-sided ones of the same order at its ends:
    exact for a quadratic. A stretch of two samples has the slope between them; a single sample
    between two gaps has no difference to take and gets 0.

    Parameters
    ----------
    time, position : ndarray, shape (n,)
        [s]; [rad] or [m].
    gaps : tuple of Gap

    Returns
    -------
    ndarray, shape (n,)
        [rad/s] or [m/s], read-only.

    Raises
    ------
    InputError
        The velocity is too large for a number.
    """
    velocity = np.zeros(len(time))
    edges = [0, *(gap.index + 1 for gap in gaps), len(time)]
    with np.errstate(all="ignore"):
        for first, last in itertools.pairwise(edges):
            stretch = slice(first, last)
            if last - first > 1:
                velocity[stretch] = np.gradient(
                    position[stretch], time[stretch], edge_order=2 if last - first > 2 else 1
                )
    finite = np.isfinite(velocity)
    if not finite.all():
        index = int(np.argmin(finite))
        raise InputError(
            f"it changes too fast for a velocity to be derived (at {float(time[index])!r} s)",
            argument="position",
            value=float(position[index]),
            place=f"index {index}",
            remedy=("give the velocity", "correct the time stamps"),
        )
    velocity.flags.writeable = False
    return velocity
