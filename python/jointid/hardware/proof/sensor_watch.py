"""Watches the torque sensor while the encoder stands: a joint that moves shows there, too."""

from __future__ import annotations

import math

_SHARE = 0.02  # of a new reading in the average: over some 50 cycles
_CLEAR = 8.0  # standard deviations of that average
_LEAST = 1e-3  # of the readings themselves: what a sensor without noise may be off


class SensorWatch:
    """Says whether the sensor's average has left the readings of a joint at rest.

    Parameters
    ----------
    mean, deviation : float
        Mean and deviation of the readings at rest; a NaN deviation means no sensor, and no reading is beyond.
    """

    def __init__(self, mean: float, deviation: float) -> None:
        self._mean = self._average = mean
        spread = math.sqrt(_SHARE / (2.0 - _SHARE))
        self._allowed = _CLEAR * max(deviation * spread, _LEAST * abs(mean))

    def begin(self) -> None:
        """Start from the present average: the joint stands elsewhere, where ripple and weight are others."""
        self._mean = self._average

    def left(self, reading: float) -> bool:
        """Take one more reading; whether the average is beyond what noise explains."""
        self._average += _SHARE * (reading - self._average)
        return abs(self._average - self._mean) > self._allowed

    def __str__(self) -> str:
        return f"{self._mean:.4g} at rest, {self._average:.4g} now"
