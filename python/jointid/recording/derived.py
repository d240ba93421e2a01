"""Velocity derived from position: differences for a fine position, local cubics for a coarse one."""

from __future__ import annotations

import itertools
from collections.abc import Sequence

import numpy as np

from jointid import _core
from jointid.base.errors import InputError
from jointid.base.values import dataclass
from jointid.recording.gaps import Gap
from jointid.recording.signals import FloatArray


@dataclass(frozen=True, kw_only=True, eq=False)
class DerivedVelocity:
    """A derived velocity and its noise.

    Attributes
    ----------
    velocity : ndarray, shape (n,)
        [rad/s] or [m/s], read-only.
    noise : ndarray, shape (n,)
        Standard deviation at each sample, from the position's noise [rad/s or m/s].
    refined : bool
        Whether local cubic fits replaced the differences.
    position_noise : PositionNoise
        Encoder step, white noise and time stamp errors.
    """

    velocity: FloatArray
    noise: FloatArray
    refined: bool
    position_noise: _core.PositionNoise


def derived_velocity(
    time: FloatArray, position: FloatArray, gaps: tuple[Gap, ...], period: float
) -> DerivedVelocity:
    """Return the velocity, with the smoothing at each sample that the position's noise requires.

    The velocity starts as second-order differences on the true time stamps. If their noise is below 0.03 % of
    the largest speed, they are the result, bit for bit. Otherwise cubics are fitted at each sample over 5 to 101
    samples. The longest fit is used for which the confidence interval overlaps those of all shorter fits
    (intersection of confidence intervals: Goldenshluger and Nemirovski 1997; Katkovnik 1999). Fits are long in
    smooth motion, and short at reversals and breakaway. No fit includes a gap.

    Parameters
    ----------
    time, position : ndarray, shape (n,)
        [s]; [rad] or [m].
    gaps : tuple of Gap
    period : float
        Median time between samples [s].

    Raises
    ------
    InputError
        The velocity is too large for a number.
    """
    difference = differences(time, position, gaps)
    after = [gap.index for gap in gaps]
    with np.errstate(all="ignore"):
        noise = _core.position_noise(time, position, after, period)
        found = _core.local_velocity(time, position, difference, after, noise)
    velocity = found.velocity if found.refined else difference
    velocity.flags.writeable = False
    return DerivedVelocity(
        velocity=velocity, noise=found.noise, refined=found.refined, position_noise=noise
    )


def differences(time: FloatArray, position: FloatArray, gaps: Sequence[Gap]) -> FloatArray:
    """Return the velocity by second-order differences on the true time stamps.

    Differences are central inside a gap-free stretch, and one-sided of the same order at its ends. They are
    exact for a quadratic. A stretch of two samples gets the slope between them. A single sample between two
    gaps gets 0.

    Parameters
    ----------
    time, position : ndarray, shape (n,)
        [s]; [rad] or [m].
    gaps : sequence of Gap

    Raises
    ------
    InputError
        The velocity is too large for a number.
    """
    velocity = np.zeros(len(time))
    edges = [0, *(gap.index + 1 for gap in gaps), len(time)]
    with np.errstate(all="ignore"):
        for first, last in itertools.pairwise(edges):
            stretch = slice(first, last)
            if last - first > 1:
                velocity[stretch] = np.gradient(
                    position[stretch], time[stretch], edge_order=2 if last - first > 2 else 1
                )
    finite = np.isfinite(velocity)
    if not finite.all():
        index = int(np.argmin(finite))
        raise InputError(
            f"the position changes too fast at {float(time[index])!r} s, so no velocity can be derived",
            argument="position",
            value=float(position[index]),
            place=f"index {index}",
            remedy=("give the velocity", "correct the time stamps"),
        )
    return velocity
