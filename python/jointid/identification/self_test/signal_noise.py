"""White noise and quantization step of a signal, and their removal."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from jointid.base.values import dataclass

Array = NDArray[np.float64]

# Sixth differences remove the smooth signal and multiply the variance of white noise by 924.
_ORDER, _KEPT = 6, 924.0
_MEDIAN = 0.6745  # median of |x| of a standard normal x
# A quantization step is accepted if this share of the steps is near a whole multiple of it, and it exceeds rounding.
_WHOLE, _NEAR, _ROUNDING = 0.98, 0.02, 1e-12
# Samples on either side for the local parabolas; the largest number is used that still removes only noise.
_REACHES = (2, 4, 8, 12, 16, 24, 32)
_MISFIT = 1.15


@dataclass(frozen=True, slots=True, kw_only=True)
class SignalNoise:
    """Noise of a recorded signal.

    Attributes
    ----------
    white : float
        Standard deviation of the white noise, including quantization.
    quantum : float
        Quantization step; 0 if none is visible.
    """

    white: float
    quantum: float

    @classmethod
    def of(cls, signal: Array) -> SignalNoise:
        """Estimate white noise and quantization step from a signal's differences."""
        quantum = _quantum(signal)
        rough = np.abs(np.diff(signal, _ORDER))
        white = float(np.median(rough)) / _MEDIAN / np.sqrt(_KEPT) if rough.size else 0.0
        if quantum:  # most differences of coarse steps are 0
            white = max(white, quantum / np.sqrt(12.0))
        return cls(white=float(white), quantum=quantum)

    def added(self, signal: Array, rng: np.random.Generator) -> Array:
        """Return a true signal with noise and quantization."""
        own = np.sqrt(max(self.white**2 - self.quantum**2 / 12.0, 0.0))
        noisy = signal + rng.normal(0.0, own, signal.size) if own > 0.0 else signal
        if self.quantum == 0.0:
            return noisy
        shift = rng.uniform(0.0, self.quantum)  # the steps may lie anywhere
        return np.asarray(np.round((noisy + shift) / self.quantum) * self.quantum - shift)

    def removed(self, signal: Array) -> Array:
        """Return the signal smoothed by local parabolas, as far as noise explains the difference."""
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
    # The mean of single steps, because the smallest one alone contains rounding.
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
    """Return the middle value of the parabola fitted to each sample's neighbors (Savitzky and Golay)."""
    place = np.arange(-reach, reach + 1, dtype=np.float64)
    powers = np.vander(place, 3, increasing=True)
    weights = np.linalg.pinv(powers)[0]
    # Beyond the ends, the signal continues as its point reflection at the end.
    before = 2.0 * signal[0] - signal[reach:0:-1]
    after = 2.0 * signal[-1] - signal[-2 : -reach - 2 : -1]
    return np.convolve(np.concatenate([before, signal, after]), weights[::-1], mode="valid")
