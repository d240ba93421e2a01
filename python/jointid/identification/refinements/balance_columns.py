"""What a signal may be a sum of, under smooth windows: wide enough that a model error is no delay."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from jointid.identification.refinements.smooth_windows import SmoothWindows
from jointid.problem.own_balance import OwnSignal

Array = NDArray[np.float64]

_LONGEST_DECAY = 0.4  # Stribeck speed, of the peak speed; each next one is half of it
_DECAYS = 6


def conservative(
    windows: SmoothWindows,
    circle: tuple[Array, Array],
    *,
    varying: bool = False,
    delayed: bool = False,
) -> list[Array]:
    """Inertia, gravity, a constant; and an inertia that varies with the angle, if that is asked for."""
    cosine, sine = circle
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


def friction(windows: SmoothWindows, circle: tuple[Array, Array]) -> list[Array]:
    """Friction as any smooth function of the speed, that may depend on direction, angle and time."""
    v = windows.stretch.velocity
    sign, speed = np.sign(v), np.abs(v)
    peak = max(float(speed.max()), 1e-300)
    smooth = v
    if windows.stretch.derived or windows.half > 6:
        smooth = np.convolve(v, windows.weight, mode="same")
    time = np.linspace(-0.5, 0.5, len(v))
    signals = [sign, v, v * speed, speed]
    decay = np.exp(-((smooth / (_LONGEST_DECAY * peak)) ** 2))
    for _ in range(_DECAYS):
        signals.append(sign * decay)
        decay = decay * decay
        decay *= decay  # of half the speed
    cosine, sine = circle
    signals += [sign * cosine, sign * sine, v * cosine, v * sine]
    signals += [sign * time, v * time]
    return [windows.mean(each) for each in signals]


def own_columns(
    windows: SmoothWindows, own: Sequence[OwnSignal], *, friction: bool, taken: bool
) -> list[Array]:
    """Return the mean torque of own terms in each window, each for a coefficient of 1.

    Parameters
    ----------
    windows : SmoothWindows
    own : sequence of OwnSignal
        Of the windows' stretch.
    friction : bool
        Which terms: friction, or what is none.
    taken : bool
        Whether known torques, which the drive's torque lacks already, are among them.
    """
    return [
        windows.rate(each.series)
        for each in own
        if each.friction == friction and (taken or not each.taken)
    ]


def stacked(columns: Sequence[Sequence[Array]]) -> Array:
    """One matrix from the columns of each stretch."""
    return np.vstack([np.column_stack(list(each)) for each in columns])
