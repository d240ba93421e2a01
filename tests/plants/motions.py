"""Reference motions of many runs, each with its exact derivatives."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from plants.columns import Array

Reference = tuple[Array, Array, Array]


@dataclass(frozen=True)
class Motion:
    """Reference positions, velocities and accelerations of many runs.

    Parameters
    ----------
    runs : int
    function : callable
        Takes times (n, 1); returns position, velocity and acceleration, each (n, runs).
    """

    runs: int
    function: Callable[[Array], Reference]

    def at(self, times: Array) -> Reference:
        """Position, velocity, acceleration at times (n,), each of shape (n, runs)."""
        q, v, a = self.function(times[:, None])
        shape = (times.size, self.runs)
        return (
            np.ascontiguousarray(np.broadcast_to(q, shape)),
            np.ascontiguousarray(np.broadcast_to(v, shape)),
            np.ascontiguousarray(np.broadcast_to(a, shape)),
        )

    @staticmethod
    def stack(parts: Sequence[Motion]) -> Motion:
        """Runs of several motions, one after the other."""

        def function(times: Array) -> Reference:
            found = [part.at(times[:, 0]) for part in parts]
            q, v, a = (np.concatenate([f[i] for f in found], axis=1) for i in range(3))
            return q, v, a

        return Motion(sum(part.runs for part in parts), function)

    def around(self, centre: npt.ArrayLike) -> Motion:
        """The same motion about another position [rad]."""
        middle = np.asarray(centre, dtype=float)

        def function(times: Array) -> Reference:
            q, v, a = self.function(times)
            return q + middle, v, a

        return Motion(self.runs, function)


def sines(amplitude: npt.ArrayLike, rate: npt.ArrayLike, phase: npt.ArrayLike = 0.0) -> Motion:
    """Sums of sines: amplitude [rad], rate [rad/s] and phase of shape (runs, sines), at rest at first.

    The sum is blended in over half a second, as a recorder that starts at rest sees it.
    """
    size, pace, begin = (
        np.atleast_2d(np.asarray(x, dtype=float)) for x in (amplitude, rate, phase)
    )
    size, pace, begin = np.broadcast_arrays(size, pace, begin)

    def function(times: Array) -> Reference:
        q = v = a = np.zeros((times.shape[0], size.shape[0]))
        for k in range(size.shape[1]):
            angle = pace[:, k] * times + begin[:, k]
            sine, cosine = size[:, k] * np.sin(angle), size[:, k] * np.cos(angle)
            q, v, a = q + sine, v + pace[:, k] * cosine, a - pace[:, k] ** 2 * sine
        return _blended(times, (q, v, a))

    return Motion(size.shape[0], function)


def thesis(amplitude: npt.ArrayLike, cycle: npt.ArrayLike = 3.0) -> Motion:
    """Trajectory (6-1): amplitude [rad] and cycle [s] of shape (runs,)."""
    size, period = np.broadcast_arrays(np.atleast_1d(np.asarray(amplitude, float)), cycle)
    pace = 2.0 * np.pi / period
    scale = size / 1.3

    def function(times: Array) -> Reference:
        angle = pace * times
        return (
            scale * (np.sin(angle) - 0.5 * np.sin(2.0 * angle)),
            scale * pace * (np.cos(angle) - np.cos(2.0 * angle)),
            scale * pace**2 * (2.0 * np.sin(2.0 * angle) - np.sin(angle)),
        )

    return Motion(size.size, function)


def chirp(
    amplitude: npt.ArrayLike, low: npt.ArrayLike, high: npt.ArrayLike, duration: float
) -> Motion:
    """Linear chirps from one frequency to another [Hz], with an amplitude [rad] that falls as the frequency rises."""
    size, first, last = np.broadcast_arrays(
        np.atleast_1d(np.asarray(amplitude, float)), np.asarray(low, float), np.asarray(high, float)
    )
    slope = (last - first) / duration

    def function(times: Array) -> Reference:
        rate = 2.0 * np.pi * (first + slope * times)
        change = 2.0 * np.pi * slope
        angle = 2.0 * np.pi * (first * times + 0.5 * slope * times**2)
        # Amplitude size · first / frequency: the peak velocity stays the same.
        scale = size * 2.0 * np.pi * first / rate
        scale_rate = -scale * change / rate
        scale_change = 2.0 * scale * (change / rate) ** 2
        sine, cosine = np.sin(angle), np.cos(angle)
        return _blended(
            times,
            (
                scale * sine,
                scale_rate * sine + scale * rate * cosine,
                scale_change * sine
                + (2.0 * scale_rate * rate + scale * change) * cosine
                - scale * rate**2 * sine,
            ),
        )

    return Motion(size.size, function)


def trapezoids(
    amplitude: npt.ArrayLike, speed: npt.ArrayLike, acceleration: npt.ArrayLike, pause: float = 0.0
) -> Motion:
    """To and fro between -amplitude and amplitude with a trapezoidal velocity, and pauses at the ends [s]."""
    size, pace, rise = np.broadcast_arrays(
        *(np.atleast_1d(np.asarray(x, dtype=float)) for x in (amplitude, speed, acceleration))
    )
    pace = np.minimum(pace, np.sqrt(2.0 * size * rise))  # a triangle where the way is short
    ramp = pace / rise
    move = 2.0 * size / pace + ramp
    half = move + pause

    def function(times: Array) -> Reference:
        number = np.floor(times / half)
        t = times - number * half
        sign = np.where(number % 2 == 0, 1.0, -1.0)
        # Way on [0, move]: up, along, down.
        up, down = t < ramp, t > move - ramp
        rest = t >= move
        back = np.maximum(move - t, 0.0)
        way = np.where(
            up,
            0.5 * rise * t**2,
            np.where(down, 2.0 * size - 0.5 * rise * back**2, pace * (t - 0.5 * ramp)),
        )
        v = np.where(up, rise * t, np.where(down, rise * back, pace))
        a = np.where(up, rise, np.where(down, -rise, 0.0))
        return sign * (way - size), sign * np.where(rest, 0.0, v), sign * np.where(rest, 0.0, a)

    return Motion(size.size, function)


def _blended(times: Array, reference: Reference, over: float = 0.5) -> Reference:
    """Faded in by 10 s³ - 15 s⁴ + 6 s⁵."""
    q, v, a = reference
    s = np.clip(times / over, 0.0, 1.0)
    w = s**3 * (10.0 - 15.0 * s + 6.0 * s**2)
    dw = 30.0 * s**2 * (1.0 - s) ** 2 / over
    ddw = 60.0 * s * (1.0 - s) * (1.0 - 2.0 * s) / over**2
    return w * q, w * v + dw * q, w * a + 2.0 * dw * v + ddw * q
