"""Convert the values of an axis to places in a picture."""

from __future__ import annotations

import math
from collections.abc import Iterable

import numpy as np
from numpy.typing import ArrayLike, NDArray

from jointid.base.values import dataclass
from jointid.report.drawing.ticks import Ticks, linear_ticks, logarithmic_ticks

Array = NDArray[np.float64]
Places = NDArray[np.int64]

_MARGIN = 0.04  # share of the range that is free at both ends
_LARGEST = 1e150  # beyond, a range has no finite size; no physical value is that large
_FINEST = 1e-9  # a range is at least this share of its values: labels could not show a finer one


@dataclass(frozen=True, slots=True)
class Scale:
    """An axis's range, and its place in the picture.

    Attributes
    ----------
    low, high : float
        Values at the two ends; positive if logarithmic.
    start, stop : int
        Places of the two ends, in tenths of a unit of the picture.
    logarithmic : bool
    """

    low: float
    high: float
    start: int
    stop: int
    logarithmic: bool = False

    def places(self, values: ArrayLike) -> Places:
        """Return the place of each value, which must be drawable."""
        given = np.asarray(values, dtype=np.float64)
        low, high = self.low, self.high
        if self.logarithmic:
            given, low, high = np.log(given), math.log(low), math.log(high)
        share = (given - low) * ((self.stop - self.start) / (high - low))
        return np.rint(share + self.start).astype(np.int64)

    def ticks(self, most: int) -> Ticks:
        """Return at most this number of ticks."""
        choose = logarithmic_ticks if self.logarithmic else linear_ticks
        return choose(self.low, self.high, most)


def drawable(values: Array, logarithmic: bool = False) -> NDArray[np.bool_]:
    """Return which values an axis can show: finite ones, and only positive ones if it is logarithmic."""
    with np.errstate(invalid="ignore"):
        shown = np.abs(values) < _LARGEST
        return shown & (values > 1.0 / _LARGEST) if logarithmic else shown


def limits(shown: Iterable[Array], logarithmic: bool = False) -> tuple[float, float]:
    """Return the range of an axis for these values, with a margin. Without values, it has some size too."""
    low, high = math.inf, -math.inf
    for values in shown:
        seen = values[drawable(values, logarithmic)]
        if seen.size:
            low, high = min(low, float(seen.min())), max(high, float(seen.max()))
    if low > high:
        return (0.1, 1.0) if logarithmic else (0.0, 1.0)
    if logarithmic:
        margin = max((high / low) ** _MARGIN, 1.05)
        return low / margin, high * margin
    size = max(abs(low), abs(high))
    least = max(_FINEST * size, 1.0 / _LARGEST)
    if high - low <= least:  # a constant is drawn in the middle
        wider = 0.5 * size if size > least else 0.5
        low, high = low - wider, high + wider
    margin = _MARGIN * (high - low)
    return low - margin, high + margin
