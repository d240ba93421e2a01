"""Bodies that have given base parameters, as nearly as these are known, and are like the URDF's otherwise.

Base parameters are combinations; many sets of links have the same. Sought is the one that bodies can have:
the least squared distance of the base parameters, in their standard errors, plus a little of the entropic divergence of
each link's matrix of moments from the URDF's (Lee, Wensing and Park 2020). Both are convex, and the divergence grows
beyond all bounds where a body ends to be possible: Newton's method from the URDF's links finds the one minimum.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from jointid.robot.bodies import moments_of, possible

Array = NDArray[np.float64]

_LIGHTEST = 1e-3  # of the links' mean mass
_SMALLEST = 1e-3  # [m]: thinner is no link
_TOGETHER = (1.0, 0.1, 0.01, 1e-3)  # weights of the divergence, one after the other
_STEPS = 60
_SETTLED = 1e-9  # of the decrease that Newton's method foresees
_SHORTEST = 1e-9  # step
_BY_CHANCE = 0.003  # probability of a larger distance if bodies have the true base parameters
# Products of the moments' matrix with the ten parameters of a link.
_CHANGES = np.array([moments_of(each) for each in np.eye(10)])


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class PossibleBodies:
    """Links that can be.

    Attributes
    ----------
    inertial : ndarray, shape (links, 10)
    distance : float
        Of their base parameters from the given ones, in standard errors.
    by_chance : bool
        Whether so large a distance may be chance.
    """

    inertial: Array
    distance: float
    by_chance: bool


def possible_bodies(wanted: Array, base: Array, precision: Array, urdf: Array) -> PossibleBodies:
    """Return possible links with given base parameters.

    Parameters
    ----------
    wanted : ndarray, shape (count,)
        Base parameters.
    base : ndarray, shape (count, 10 n)
        How they follow from the links' inertial parameters.
    precision : ndarray, shape (count, count)
        Inverse of their covariance; positive definite.
    urdf : ndarray, shape (n, 10)
    """
    from scipy.special import chdtri

    start = _as_bodies(urdf)
    found = start
    for weight in _TOGETHER:
        found = _nearest(found, start, wanted, base, precision, weight)
    exact = _with_base(found, wanted, base, start)
    if possible(exact):
        return PossibleBodies(inertial=exact, distance=0.0, by_chance=True)
    missed = base @ found.ravel() - wanted
    distance = float(np.sqrt(max(missed @ precision @ missed, 0.0)))
    limit = float(np.sqrt(chdtri(wanted.size, _BY_CHANCE)))
    return PossibleBodies(inertial=found, distance=distance, by_chance=distance <= limit)


def _as_bodies(inertial: Array) -> Array:
    """The nearest links with some mass and extent."""
    lightest = _LIGHTEST * float(np.maximum(inertial[:, 0], 0.0).mean()) or _LIGHTEST
    found = np.empty_like(inertial)
    for number, each in enumerate(inertial):
        mass = max(float(each[0]), lightest)
        moments = moments_of(each)
        moments[3, 3] = mass
        centre = moments[:3, 3] / mass
        about = moments[:3, :3] - mass * np.outer(centre, centre)
        values, vectors = np.linalg.eigh(0.5 * (about + about.T))
        values = np.maximum(values, mass * _SMALLEST**2)
        moments[:3, :3] = (vectors * values) @ vectors.T + mass * np.outer(centre, centre)
        found[number] = _parameters(moments)
    return found


def _parameters(moments: Array) -> Array:
    """The ten parameters of a link with this matrix of moments."""
    turning = np.trace(moments[:3, :3]) * np.eye(3) - moments[:3, :3]
    xx, xy, xz, yy, yz, zz = turning[np.triu_indices(3)]
    return np.array([moments[3, 3], *moments[:3, 3], xx, xy, yy, xz, yz, zz])


def _with_base(inertial: Array, wanted: Array, base: Array, sizes: Array) -> Array:
    """The links with exactly these base parameters, by the smallest change in terms of the links' own sizes."""
    mass = sizes[:, :1]
    turning = np.sqrt((sizes[:, 4] + sizes[:, 6] + sizes[:, 9])[:, None] / mass)
    scale = np.hstack([mass, *(mass * turning,) * 3, *(mass * turning**2,) * 6]).ravel()
    change = np.linalg.lstsq(base * scale, wanted - base @ inertial.ravel(), rcond=None)[0]
    return np.asarray(inertial + (scale * change).reshape(inertial.shape))


def _nearest(
    found: Array, urdf: Array, wanted: Array, base: Array, precision: Array, weight: float
) -> Array:
    """The minimum with one weight of the divergence, by damped Newton steps."""
    pull = np.array(
        [np.einsum("iab,ab->i", _CHANGES, np.linalg.inv(moments_of(each))) for each in urdf]
    )

    def value(inertial: Array) -> float:
        missed = base @ inertial.ravel() - wanted
        signs, logs = np.linalg.slogdet(np.array([moments_of(each) for each in inertial]))
        if np.any(signs <= 0.0) or not possible(inertial):
            return np.inf
        return float(0.5 * missed @ precision @ missed + weight * (np.sum(pull * inertial) - logs.sum()))

    now = value(found)
    of_base = base.T @ precision @ base
    for _ in range(_STEPS):
        slope = base.T @ (precision @ (base @ found.ravel() - wanted))
        curvature = of_base.copy()
        for number, each in enumerate(found):
            inverse = np.linalg.inv(moments_of(each))
            turned = np.einsum("ab,ibc->iac", inverse, _CHANGES)
            mine = slice(10 * number, 10 * number + 10)
            slope[mine] += weight * (pull[number] - np.einsum("iaa->i", turned))
            curvature[mine, mine] += weight * np.einsum("iab,jba->ij", turned, turned)
        size = 1.0 / np.sqrt(np.diag(curvature))
        scaled = curvature * np.outer(size, size)
        step = -size * np.linalg.lstsq(scaled, size * slope, rcond=1e-14)[0]
        foreseen = -float(slope @ step)
        if foreseen < _SETTLED:
            break
        length = 1.0
        while length > _SHORTEST:
            trial = found + length * step.reshape(found.shape)
            after = value(trial)
            if after <= now - 0.25 * length * foreseen:
                found, now = trial, after
                break
            length *= 0.5
        else:
            break
    return found
