"""White noise and quantum of a signal, and the signal without them."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from jointid.base.values import dataclass

Array = NDArray[np.float64]

# Sixth differences remove what is smooth; of white noise they keep 924 times its variance.
_ORDER, _KEPT = 6, 924.0
_MEDIAN = 0.6745  # median of |x| of a standard normal x
# A quantum is believed if so many of the steps are near a whole multiple of it, and it is coarser than rounding.
_WHOLE, _NEAR, _ROUNDING = 0.98, 0.02, 1e-12
# Samples on either side that the local parabolas take: the most whose misfit is still the noise.
_REACHES = (2, 4, 8, 12, 16, 24, 32)
_MISFIT = 1.15


@dataclass(frozen=True, slots=True, kw_only=True)
class SignalNoise:
    """What a recorded signal has beside the true one.

    Attributes
    ----------
    white : float
        Standard deviation of its white noise, its quantum's included.
    quantum : float
        Step of its values; 0 if none is seen.
    """

    white: float
    quantum: float

    @classmethod
    def of(cls, signal: Array) -> SignalNoise:
        """Estimate both from a signal's differences."""
        quantum = _quantum(signal)
        rough = np.abs(np.diff(signal, _ORDER))
        white = float(np.median(rough)) / _MEDIAN / np.sqrt(_KEPT) if rough.size else 0.0
        if quantum:  # most differences of coarse steps are 0
            white = max(white, quantum / np.sqrt(12.0))
        return cls(white=float(white), quantum=quantum)

    def added(self, signal: Array, rng: np.random.Generator) -> Array:
        """Return a true signal as it would be recorded."""
        own = np.sqrt(max(self.white**2 - self.quantum**2 / 12.0, 0.0))
        noisy = signal + rng.normal(0.0, own, signal.size) if own > 0.0 else signal
        if self.quantum == 0.0:
            return noisy
        shift = rng.uniform(0.0, self.quantum)  # the steps may lie anywhere
        return np.asarray(np.round((noisy + shift) / self.quantum) * self.quantum - shift)

    def removed(self, signal: Array) -> Array:
        """Return the signal smoothed by local parabolas, as far as its noise explains the difference."""
        best = signal
        for reach in _REACHES:
            if 2 * reach + 1 >= signal.size:
                break
            smooth = _parabolas(signal, reach)
            left = float(np.sqrt(np.mean(np.square(smooth - signal))))
            if left > _MISFIT * self.white:
                break
            best = smooth
        return best


def _quantum(signal: Array) -> float:
    steps = np.abs(np.diff(signal))
    extent = float(np.ptp(signal))
    steps = steps[steps > _ROUNDING * max(extent, float(np.abs(signal).max()))]
    if steps.size < 10:
        return 0.0
    smallest = float(steps.min())
    # The mean of the single steps: the smallest alone carries rounding.
    single = steps[steps < 1.5 * smallest]
    quantum = float(single.mean())
    share = steps / quantum
    if (
        single.size < 5
        or np.mean(np.abs(share - np.round(share)) < _NEAR * np.maximum(1.0, share)) < _WHOLE
    ):
        return 0.0
    return quantum


def _parabolas(signal: Array, reach: int) -> Array:
    """Return the value in the middle of the parabola through each sample's neighbours (Savitzky and Golay)."""
    place = np.arange(-reach, reach + 1, dtype=np.float64)
    powers = np.vander(place, 3, increasing=True)
    weights = np.linalg.pinv(powers)[0]
    # Beyond the ends the signal goes on by its mirror image through the end.
    before = 2.0 * signal[0] - signal[reach:0:-1]
    after = 2.0 * signal[-1] - signal[-2 : -reach - 2 : -1]
    return np.convolve(np.concatenate([before, signal, after]), weights[::-1], mode="valid")
