"""The torque balance under smooth windows: the rows from which delays are estimated.

A window with edges takes the velocity at its edges, whose noise spoils short windows. Under a smooth weight
that is zero at both ends (a modulating function) the acceleration is the velocity, or the position itself,
summed with the weight's derivatives: noise averages out, and neighbouring windows overlap.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.base.values import dataclass
from jointid.recording.order_statistics import median

Array = NDArray[np.float64]

_HALF_LENGTHS = (6, 8, 11, 15, 20, 28, 40, 56)  # samples
_NOISE_SHARE = 1e-4  # largest variance of the acceleration's noise over its own


@dataclass(frozen=True, kw_only=True)
class Stretch:
    """A stretch of a recording without a gap.

    Attributes
    ----------
    time, position, velocity : ndarray, shape (n,)
    usable : ndarray of bool, shape (n,)
        Whether friction is defined at the sample: the joint neither sticks nor stands.
    derived : bool
        Whether the velocity was derived from the position.
    """

    time: Array
    position: Array
    velocity: Array
    usable: NDArray[np.bool_]
    derived: bool

    @property
    def period(self) -> float:
        """Mean time between samples [s]."""
        return float(self.time[-1] - self.time[0]) / (len(self.time) - 1)

    @cached_property
    def unusable_before(self) -> NDArray[np.int64]:
        """How many samples before each are not usable, shape (n + 1,)."""
        before = np.empty(len(self.usable) + 1, dtype=np.int64)
        before[0] = 0
        np.cumsum(~self.usable, out=before[1:])
        return before

    @cached_property
    def turned_before(self) -> NDArray[np.int64]:
        """How many changes of direction are before each sample, shape (n,)."""
        # Two comparisons instead of a sign; a sample at rest has a direction of its own.
        forward, backward = self.velocity > 0.0, self.velocity < 0.0
        turned = np.empty(len(self.velocity), dtype=np.int64)
        turned[0] = 0
        changes = (forward[1:] != forward[:-1]) | (backward[1:] != backward[:-1])
        np.cumsum(changes, out=turned[1:])
        return turned


@dataclass(frozen=True, kw_only=True)
class SmoothWindows:
    """Smooth windows over one stretch.

    Attributes
    ----------
    stretch : Stretch
    half : int
        Half the length of a window, in samples.
    stride : int
        Samples from one window to the next.
    margin : int
        Samples that a signal may be shifted by.
    clear : int
        No window has its middle nearer than this to a change of direction, in samples; 0: no such rule.
    usable_only : bool
        Whether windows that touch an unusable sample are left out.
    """

    stretch: Stretch
    half: int
    stride: int
    margin: int
    clear: int = 0
    usable_only: bool = True

    @cached_property
    def weight(self) -> Array:
        """Weights of the samples in a window; they sum to one."""
        k = np.arange(-self.half + 1, self.half)
        weight = 1.0 + np.cos(np.pi * k / self.half)
        return np.asarray(weight / weight.sum())

    @cached_property
    def slope(self) -> Array:
        """Weights of the samples that sum to the mean slope of a signal in the window [1/s]."""
        return _slope(self.half, self.stretch.period)

    @cached_property
    def middles(self) -> NDArray[np.int64]:
        """Middle sample of every window, the ones left out included."""
        reach = self.half + self.margin + 2
        return np.arange(reach, len(self.stretch.time) - reach, self.stride)

    @cached_property
    def kept(self) -> NDArray[np.bool_]:
        """Which of these windows are used."""
        stretch = self.stretch
        kept = np.ones(len(self.middles), dtype=bool)
        if self.usable_only:
            before = stretch.unusable_before
            kept = self._beside(before, self.half) == self._beside(before, -self.half)
        if self.clear:
            turned = stretch.turned_before
            kept &= self._beside(turned, self.clear) == self._beside(turned, -self.clear)
        return np.asarray(kept)

    def _beside(self, counts: NDArray[np.int64], apart: int) -> NDArray[np.int64]:
        """Those of the samples so many behind the middles, which lie evenly."""
        if not len(self.middles):
            return counts[:0]
        first = int(self.middles[0]) + apart
        return counts[first : first + len(self.middles) * self.stride : self.stride][
            : len(self.middles)
        ]

    @cached_property
    def used(self) -> NDArray[np.int64]:
        """Middle samples of the windows that are used."""
        return np.asarray(self.middles[self.kept])

    def mean(self, signal: Array) -> Array:
        """Weighted mean of a signal in each window."""
        return self._weighted(signal, self.weight)

    def rate(self, signal: Array) -> Array:
        """Mean rate of a signal in each window."""
        return self._weighted(signal, self.slope)

    def acceleration(self, delayed: bool = False) -> Array:
        """Mean acceleration in each window.

        Parameters
        ----------
        delayed : bool
            Whether half a sample earlier: that of the interval before a sample. Default False.
        """
        if self.stretch.derived:
            signal, weight = self.stretch.position, _curvature(self.half, self.stretch.period)
        else:
            signal, weight = self.stretch.velocity, self.slope
        if delayed:
            signal = np.concatenate([signal[:1], 0.5 * (signal[1:] + signal[:-1])])
        return self._weighted(signal, weight)

    def _weighted(self, signal: Array, weight: Array) -> Array:
        return np.asarray(_core.window_means(signal, weight, self.used))


def half_length(stretch: Stretch, shortest: int = 6) -> int:
    """Return the shortest half length that averages the acceleration's noise to 1e-4 of its variance."""
    period = stretch.period
    noise = _noise(stretch.position if stretch.derived else stretch.velocity)
    signal = stretch.position if stretch.derived else stretch.velocity
    if stretch.derived:
        steps = np.abs(np.diff(signal))
        smallest = float(np.min(steps[steps > 0.0], initial=np.inf))
        if 1e-3 * float(steps.max(initial=0.0)) < smallest < np.inf:
            noise = max(noise, smallest / np.sqrt(12.0))
    halves = [half for half in (shortest, *_HALF_LENGTHS) if half >= shortest]
    for half in halves:
        weight = _curvature(half, period) if stretch.derived else _slope(half, period)
        if 4 * len(weight) > len(signal):
            return half
        each = len(weight) // 2  # samples either side
        middles = np.arange(each, len(signal) - each, half)
        rough = np.asarray(_core.window_means(signal, weight, middles))
        if noise**2 * float(weight @ weight) <= _NOISE_SHARE * float(np.var(rough)):
            return half
    return halves[-1]


def _slope(half: int, period: float) -> Array:
    k = np.arange(-half + 1, half)
    weight = np.sin(np.pi * k / half)
    return np.asarray(weight / (float(weight @ k) * period))


def _curvature(half: int, period: float) -> Array:
    k = np.arange(-half + 1, half)
    weight = 1.0 + np.cos(np.pi * k / half)
    wide = np.concatenate([[0.0, 0.0], weight, [0.0, 0.0]])
    change: Array = (wide[2:] - 2.0 * wide[1:-1] + wide[:-2]) / (weight.sum() * period**2)
    return change


def _noise(signal: Array) -> float:
    """Standard deviation of white noise on a smooth signal: third differences, few of them large."""
    # Differences of differences, of every third sample only.
    count = (len(signal) - 1) // 3
    first, second, third, fourth = (signal[i : i + 3 * count : 3] for i in range(4))
    change = third - second
    rough = ((fourth - third) - change) - (change - (second - first))
    return float(1.4826 * median(np.abs(rough)) / np.sqrt(20.0))
