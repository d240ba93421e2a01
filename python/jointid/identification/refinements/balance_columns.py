"""What a signal may be a sum of, under smooth windows: wide enough that a model error is no delay."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from jointid.identification.refinements.smooth_windows import SmoothWindows

Array = NDArray[np.float64]

_DECAYS = (0.012, 0.025, 0.05, 0.1, 0.2, 0.45)  # Stribeck speeds, of the peak speed


def conservative(
    windows: SmoothWindows, angle: Array, *, varying: bool = False, delayed: bool = False
) -> list[Array]:
    """Inertia, gravity, a constant; and an inertia that varies with the angle, if that is asked for."""
    cosine, sine = np.cos(angle), np.sin(angle)
    columns = [
        windows.acceleration(delayed),
        windows.mean(cosine),
        windows.mean(sine),
        np.ones(len(windows.used)),
    ]
    if varying:
        v = windows.stretch.velocity
        columns += [windows.rate(v * cosine), windows.rate(v * sine)]
        columns += [windows.mean(v * v * cosine), windows.mean(v * v * sine)]
    return columns


def friction(windows: SmoothWindows, angle: Array) -> list[Array]:
    """Friction as any smooth function of the speed, that may depend on direction, angle and time."""
    v = windows.stretch.velocity
    sign, speed = np.sign(v), np.abs(v)
    peak = max(float(speed.max()), 1e-300)
    smooth = v
    if windows.stretch.derived or windows.half > 6:
        smooth = np.convolve(v, windows.weight, mode="same")
    time = np.linspace(-0.5, 0.5, len(v))
    signals = [sign, v, v * speed, speed]
    signals += [sign * np.exp(-((smooth / (share * peak)) ** 2)) for share in _DECAYS]
    signals += [sign * np.cos(angle), sign * np.sin(angle), v * np.cos(angle), v * np.sin(angle)]
    signals += [sign * time, v * time]
    return [windows.mean(each) for each in signals]


def stacked(columns: Sequence[Sequence[Array]]) -> Array:
    """One matrix from the columns of each stretch."""
    return np.vstack([np.column_stack(list(each)) for each in columns])
