"""What a signal may be a sum of, under smooth windows: wide enough that a model error is no delay."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.identification.refinements.smooth_windows import SmoothWindows
from jointid.problem.own_balance import OwnSignal

Array = NDArray[np.float64]

_LONGEST_DECAY = 0.4  # Stribeck speed, of the peak speed; each next one is half of it


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
    stretch, (cosine, sine) = windows.stretch, circle
    smooth = stretch.velocity
    if stretch.derived or windows.half > 6:
        smooth = np.asarray(_core.smoothed(smooth, windows.weight))
    means = _core.friction_means(
        stretch.velocity,
        smooth,
        cosine,
        sine,
        longest=_LONGEST_DECAY,
        weight=windows.weight,
        middles=windows.used,
    )
    return list(np.asarray(means).T)


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
    parts = [np.array(each) for each in columns]
    return (parts[0] if len(parts) == 1 else np.concatenate(parts, axis=1)).T
