"""The next piece of samples to process, with its context on both sides."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from jointid.online.plan import Plan

Array = NDArray[np.float64]

SHORTEST = 8  # samples: shortest recording
_LONG = 3.5  # sample periods: a longer interval is a gap, as in a recording


@dataclass(frozen=True, slots=True, kw_only=True)
class Piece:
    """Samples `begin` to `end`, both included, within their context `before` to `after` - 1.

    Attributes
    ----------
    next : int
        First sample of the next piece: `end`, or the first sample after a gap.
    """

    begin: int
    end: int
    before: int
    after: int
    next: int


def next_piece(times: Array, begin: int, plan: Plan) -> Piece | None:
    """Return the piece that begins with sample `begin`, or None while it is not complete.

    A piece ends at a gap, or after the plan's duration. No piece contains a gap, and samples older than
    the window are removed in time.
    """
    if begin + 1 >= len(times):
        return None
    end = int(np.searchsorted(times, times[begin] + plan.stretch - 0.25 * plan.period))
    end = max(end, begin + 1)
    jumps = np.flatnonzero(np.diff(times[begin : end + 1]) > _LONG * plan.period)
    if jumps.size > 0:
        end = begin + int(jumps[0])
        following, after = end + 1, end + 2
    elif end >= len(times):
        return None
    else:
        following = end
        after = int(np.searchsorted(times, times[end] + plan.context)) + 1
    before = max(0, int(np.searchsorted(times, times[begin] - plan.context)) - 1)
    before = min(before, max(0, after - SHORTEST))
    after = max(after, before + SHORTEST)
    if after > len(times):
        return None
    return Piece(begin=begin, end=end, before=before, after=after, next=following)
