"""Velocity derived from position: differences where the position is fine, local cubics where it is coarse."""

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
    """A velocity and how well it is known.

    Attributes
    ----------
    velocity : ndarray, shape (n,)
        [rad/s] or [m/s], read-only.
    noise : ndarray, shape (n,)
        Its standard deviation at each sample, from the position's noise [rad/s or m/s].
    refined : bool
        Whether fits over more samples replaced the differences.
    position_noise : PositionNoise
        The encoder's step, white noise, and errors of the stamps.
    """

    velocity: FloatArray
    noise: FloatArray
    refined: bool
    position_noise: _core.PositionNoise


def derived_velocity(
    time: FloatArray, position: FloatArray, gaps: tuple[Gap, ...], period: float
) -> DerivedVelocity:
    """Return the velocity, with as much smoothing at each sample as the position's noise asks for.

    It begins with second-order differences on the true time stamps. Where their noise is below 0.03 % of
    the largest speed, they stay, bit for bit. Otherwise cubics are fitted at each sample over 5 to 101
    samples, and the longest is used whose confidence interval meets those of all shorter ones
    (intersection of confidence intervals: Goldenshluger and Nemirovski 1997; Katkovnik 1999): long in
    smooth motion, short at reversals and where the joint breaks away. No fit reaches across a gap.

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

    Central differences inside a gap-free stretch, one-sided ones of the same order at its ends:
    exact for a quadratic. A stretch of two samples has the slope between them; a single sample
    between two gaps has no difference to take and gets 0.

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
            f"it changes too fast for a velocity to be derived (at {float(time[index])!r} s)",
            argument="position",
            value=float(position[index]),
            place=f"index {index}",
            remedy=("give the velocity", "correct the time stamps"),
        )
    return velocity
