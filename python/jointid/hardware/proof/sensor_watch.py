"""Watch of the torque sensor while the encoder shows no motion. A motion of the joint changes its readings, too."""

from __future__ import annotations

import math

_SHARE = 0.02  # weight of a new reading in the average, over some 50 cycles
_CLEAR = 8.0  # standard deviations of that average
_LEAST = 1e-3  # share of the readings; possible drift of a sensor without noise


class SensorWatch:
    """Watch that compares the sensor's average with the readings of a joint at rest.

    Parameters
    ----------
    mean, deviation : float
        Mean and standard deviation of the readings at rest. Without a sensor the deviation is NaN, and no reading is
        outside.
    """

    def __init__(self, mean: float, deviation: float) -> None:
        self._mean = self._average = mean
        spread = math.sqrt(_SHARE / (2.0 - _SHARE))
        self._allowed = _CLEAR * max(deviation * spread, _LEAST * abs(mean))

    def begin(self) -> None:
        """Start from the present average: at another position, ripple and weight differ."""
        self._mean = self._average

    def left(self, reading: float) -> bool:
        """Take one more reading. Return whether noise cannot explain the average."""
        self._average += _SHARE * (reading - self._average)
        return abs(self._average - self._mean) > self._allowed

    def __str__(self) -> str:
        return f"{self._mean:.4g} at rest, {self._average:.4g} now"
