"""Suitability of an estimate for its purposes: the relative half width of the 95 % interval that each purpose needs."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.balance.covariance import Covariance
from jointid.base.values import dataclass
from jointid.estimate.intervals import NORMAL
from jointid.estimate.statistics import ParameterEstimate, distance_from_bound
from jointid.problem.inner_products import column_sizes, size

Array = NDArray[np.float64]

NOTHING = 0.01
"""Share of the torque below which friction is negligible."""

_FRICTION = 0.2  # share of the torque; smallest reference for all friction
_SHARE = 0.05  # share of the torque; smallest reference for a single parameter


@dataclass(frozen=True, slots=True, kw_only=True)
class Torques:
    """Size of the torques in the recorded motion, in the unit of the residuals.

    Attributes
    ----------
    single : mapping of str to float
        Torque of each term with coefficient 1.
    friction : frozenset of str
        Names of the coefficients and shapes of friction.
    of_friction, of_drive : float
        Torque of all friction, and torque of the drive.
    """

    single: Mapping[str, float]
    friction: frozenset[str]
    of_friction: float
    of_drive: float

    @property
    def friction_level(self) -> float:
        """Reference for errors of friction: all friction, or a fifth of the torque if that is larger."""
        return max(self.of_friction, _FRICTION * self.of_drive)

    def is_friction(self, name: str) -> bool:
        """Return whether a parameter is a coefficient of friction, not a shape."""
        return name in self.friction and name in self.single

    def of_all_friction(self, name: str, value: float) -> float:
        """Return the share of all friction of a coefficient with this value in the recorded motion."""
        torque = self.single[name]
        return value * torque / self.friction_level if torque > 0.0 else 0.0

    def is_nothing(self, p: ParameterEstimate) -> bool:
        """Return whether a friction coefficient is negligible: its interval is small compared with the torque."""
        if p.interval is None or not self.is_friction(p.name):
            return False
        largest = max(-p.interval[0], p.interval[1])
        return self.single[p.name] * largest <= NOTHING * self.of_drive

    @classmethod
    def of(cls, penalty: _core.Penalty, jacobian: Array, best: Array) -> Torques:
        """Return the torques of a fit, from the derivatives of its residuals by all parameters."""
        names, count = list(penalty.names), penalty.coefficients
        places = [index for index, term in enumerate(penalty.terms) if term.friction]
        gain = best[names.index("sensor_gain")] if "sensor_gain" in names else 1.0
        scale = gain if penalty.residual == _core.Residual.sensor else 1.0
        return cls(
            single=dict(zip(names, column_sizes(jacobian[:, :count]).tolist(), strict=False)),
            friction=frozenset([*(names[index] for index in places), *names[count:]]),
            of_friction=size(np.einsum("ij,j->i", jacobian[:, places], best[places])),
            of_drive=size(np.asarray(penalty.target)) / abs(float(scale)),
        )


def within(
    parameters: Mapping[str, ParameterEstimate],
    names: Sequence[str],
    spread: Covariance,
    gram: Array,
    torques: Torques,
) -> dict[str, float]:
    """Return the relative error of each purpose's quantity; purposes without a known error are missing.

    Compensation needs the friction torque of the recorded motion, and simulation the whole torque, both as root mean
    square. Monitoring needs each parameter separately, with random errors only. The error of a parameter with
    a small torque is taken relative to a share of the drive's torque.

    Parameters
    ----------
    names : sequence of str
        Names of the parameters in `spread`.
    gram : ndarray, shape (p, p)
        Inner products of the residuals' derivatives by these parameters.
    """
    chance = np.sqrt(np.diag(spread.matrix))
    held = {
        name: distance_from_bound(p) * torques.single[name]
        for name, p in parameters.items()
        if p.at_bound is not None and name in torques.single
    }
    floor = _SHARE * torques.of_drive
    changes = [
        NORMAL * error * torque / max(abs(parameters[name].value) * torque, floor)
        for name, error in zip(names, chance.tolist(), strict=True)
        if "offset" not in name and (torque := torques.single.get(name, 0.0)) > 0.0
    ]
    # An infinite variance times zero torque: that purpose has no value.
    with np.errstate(invalid="ignore"):
        squares = _squared_half_widths(parameters, names, spread.matrix, chance) * gram
    own = [index for index, name in enumerate(names) if name in torques.friction]
    of_friction = float(squares[np.ix_(own, own)].sum())
    of_friction += sum(torque**2 for name, torque in held.items() if name in torques.friction)
    of_all = float(squares.sum()) + sum(torque**2 for torque in held.values())
    found = {
        "compensation": math.sqrt(max(of_friction, 0.0)) / (torques.friction_level or math.nan),
        "simulation": math.sqrt(max(of_all, 0.0)) / (torques.of_drive or math.nan),
        "monitoring": max([*changes, *(torque / (floor or math.nan) for torque in held.values())]),
    }
    return {purpose: share for purpose, share in found.items() if math.isfinite(share)}


def _squared_half_widths(
    parameters: Mapping[str, ParameterEstimate], names: Sequence[str], matrix: Array, chance: Array
) -> Array:
    """Return the covariance, scaled to the squared half widths of the intervals on its diagonal.

    Parameters with an unknown interval keep their random error. The uncertainty that an offset shares with the
    asymmetry of friction is removed, because it does not change the torque.
    """
    scale = np.full(len(names), NORMAL)
    for index, name in enumerate(names):
        interval = parameters[name].interval
        if interval is not None and math.isfinite(interval[1]) and chance[index] > 0.0:
            half = 0.5 * (interval[1] - interval[0])
            shared = NORMAL * parameters[name].systematic.get("symmetry", 0.0)
            scale[index] = math.sqrt(max(half**2 - shared**2, 0.0)) / chance[index]
    return np.asarray(matrix * np.outer(scale, scale))
