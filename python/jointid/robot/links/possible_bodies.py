"""Find bodies that have given base parameters within their errors and are otherwise close to the URDF's.

Base parameters are combinations, so many sets of links have the same ones. The search finds the physically consistent
set with the smallest sum of two terms. The first is the squared distance of the base parameters, in standard errors.
The second is a small weight times the entropic divergence of each link's matrix of moments from the URDF's (Lee,
Wensing and Park 2020). Both terms are convex, and the divergence is infinite at the limit of possible bodies. So
Newton's method from the URDF's links finds the one minimum.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.robot.links.bodies import moments_of, possible

Array = NDArray[np.float64]

_LIGHTEST = 0.01  # of the links' mean mass
_SMALLEST = 0.01  # [m]: a link is hardly thinner
_TOGETHER = (1.0, 0.1, 0.01, 1e-3, 1e-4)  # weights of the divergence, one after the other
_NEAR_ENOUGH = 0.01  # from this weight on, the remaining distance is removed
_STEPS = 400
_HEAVY = 10.0  # usual ratio of the inertia of a motor behind its gear to its link's
_SETTLED = 1e-9  # of the decrease that Newton's method predicts
_SHORTEST = 1e-9  # shortest step
_BY_CHANCE = 0.003  # probability of a larger distance if bodies have the true base parameters
# Matrix of moments by each of the ten parameters of a link.
_CHANGES = np.array([moments_of(each) for each in np.eye(10)])


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class PossibleBodies:
    """Physically consistent links."""

    inertial: Array  # (links, 10)
    distance: float  # distance of their base parameters from the given ones, in standard errors
    by_chance: bool  # True if a distance of this size may be chance


def nearest_possible(
    wanted: Array, base: Array, precision: Array, urdf: Array, discs: Array
) -> PossibleBodies:
    """Return the possible links nearest to the base parameters `wanted`, which are `base` times inertial parameters.

    `precision` is the inverse of the covariance of `wanted`, positive definite. A column of `discs`, (10 n, motors), is
    the effect of a unit of motor inertia on links that no motion separates from it. The URDF's links lack this inertia.
    """
    start = _as_bodies(urdf)
    search = _Search(
        urdf=start,
        wanted=wanted,
        base=np.hstack([base, base @ discs]),
        precision=precision,
        usual=np.full(discs.shape[1], _HEAVY * float(start[:, [4, 6, 9]].max(axis=1).mean())),
    )
    at = np.append(start.ravel(), search.usual)
    links = start.size
    found = start
    for weight in _TOGETHER:
        at = search.minimum(at, weight)
        found = (at[:links] + discs @ at[links:]).reshape(start.shape)
        exact = _with_base(found, wanted, base, start)
        if weight <= _NEAR_ENOUGH and possible(exact):
            return PossibleBodies(inertial=exact, distance=0.0, by_chance=True)
    missed = base @ found.ravel() - wanted
    distance = float(np.sqrt(np.maximum(missed @ precision @ missed, 0.0)))
    limit = _core.chi_square_quantile(_BY_CHANCE, wanted.size) ** 0.5
    return PossibleBodies(inertial=found, distance=distance, by_chance=distance <= limit)


def _as_bodies(inertial: Array) -> Array:
    """Return the nearest links with some mass and size."""
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
    """Return the ten parameters of a link with this matrix of moments."""
    turning = np.trace(moments[:3, :3]) * np.eye(3) - moments[:3, :3]
    xx, xy, xz, yy, yz, zz = turning[np.triu_indices(3)]
    return np.array([moments[3, 3], *moments[:3, 3], xx, xy, yy, xz, yz, zz])


def _with_base(inertial: Array, wanted: Array, base: Array, sizes: Array) -> Array:
    """Return the links with exactly these base parameters, by the smallest change relative to the links' sizes."""
    mass = sizes[:, :1]
    turning = np.sqrt((sizes[:, 4] + sizes[:, 6] + sizes[:, 9])[:, None] / mass)
    scale = np.hstack([mass, *(mass * turning,) * 3, *(mass * turning**2,) * 6]).ravel()
    change = np.linalg.lstsq(base * scale, wanted - base @ inertial.ravel(), rcond=None)[0]
    return np.asarray(inertial + (scale * change).reshape(inertial.shape))


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class _Search:
    """Damped Newton steps; the variables are the links' parameters, then the motors' inertias."""

    urdf: Array  # (n, 10)
    wanted: Array  # (count,)
    base: Array  # (count, variables)
    precision: Array  # (count, count)
    usual: Array  # (motors,), sizes of the motors' inertias

    def minimum(self, at: Array, weight: float) -> Array:
        """Return the minimum for one weight of the divergence."""
        now = self._value(at, weight)
        for _ in range(_STEPS):
            slope, curvature = self._derivatives(at, weight)
            size = 1.0 / np.sqrt(np.diag(curvature))
            scaled = curvature * np.outer(size, size)
            step = -size * np.linalg.lstsq(scaled, size * slope, rcond=1e-14)[0]
            foreseen = -float(slope @ step)
            if foreseen < _SETTLED:
                break
            length = 1.0
            while length > _SHORTEST:
                trial = at + length * step
                after = self._value(trial, weight)
                if after <= now - 0.25 * length * foreseen:
                    at, now = trial, after
                    break
                length *= 0.5
            else:
                break
        return at

    @property
    def _pull(self) -> Array:
        return np.array([_products(_inverse(each)) for each in self.urdf])

    def _value(self, at: Array, weight: float) -> float:
        links, motors = self._parts(at)
        moments = np.array([moments_of(each) for each in links])
        if np.any(motors <= 0.0) or np.linalg.eigvalsh(moments).min() <= 0.0:
            return np.inf
        missed = self.base @ at - self.wanted
        size = motors / self.usual
        away = np.sum(self._pull * links) - np.linalg.slogdet(moments)[1].sum()
        away += np.sum(size - np.log(size))
        return float(0.5 * missed @ self.precision @ missed + weight * away)

    def _derivatives(self, at: Array, weight: float) -> tuple[Array, Array]:
        links, motors = self._parts(at)
        slope = self.base.T @ (self.precision @ (self.base @ at - self.wanted))
        curvature = self.base.T @ self.precision @ self.base
        for number, each in enumerate(links):
            inverse = _inverse(each)
            turned = np.einsum("ab,ibc->iac", inverse, _CHANGES)
            mine = slice(10 * number, 10 * number + 10)
            slope[mine] += weight * (self._pull[number] - _products(inverse))
            curvature[mine, mine] += weight * np.einsum("iab,jba->ij", turned, turned)
        behind = np.arange(links.size, at.size)
        slope[behind] += weight * (1.0 / self.usual - 1.0 / motors)
        curvature[behind, behind] += weight / motors**2
        return slope, curvature

    def _parts(self, at: Array) -> tuple[Array, Array]:
        return at[: self.urdf.size].reshape(self.urdf.shape), at[self.urdf.size :]


def _inverse(link: Array) -> Array:
    return np.asarray(np.linalg.inv(moments_of(link)), dtype=np.float64)


def _products(matrix: Array) -> Array:
    """Return traces of the products with the changes of a link's moments."""
    return np.asarray(np.einsum("iab,ab->i", _CHANGES, matrix))
