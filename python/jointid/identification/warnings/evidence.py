"""Inputs shared by all warning checks."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.balance.covariance import Triangle
from jointid.base.values import dataclass
from jointid.estimate.causes import Cause, Causes
from jointid.estimate.cross_check import CrossCheck
from jointid.estimate.delays import Delay
from jointid.estimate.slow_motion import SlowMotion
from jointid.estimate.statistics import ParameterEstimate, ResidualStatistics
from jointid.identification.inference.own_noise import OwnNoise
from jointid.identification.inference.purposes import Torques
from jointid.identification.inference.velocity_noise import VelocityEffect
from jointid.identification.warnings.inspection import Inspected
from jointid.joint.joint import Joint
from jointid.problem.constant_torque import Undivided, undivided
from jointid.problem.inner_products import size
from jointid.problem.problem import Problem
from jointid.problem.window_table import WindowTable
from jointid.recording.recording import Recording

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True)
class Regressor:
    """Window integrals of all terms, then of the torque, as the triangular factor of a QR decomposition.

    Attributes
    ----------
    names : tuple of str
        Names of the coefficients.
    triangle : Triangle
    """

    names: tuple[str, ...]
    triangle: Triangle

    def norm(self, name: str) -> float:
        """Return the norm of a term's integrals."""
        return size(self.triangle.matrix[:, self.names.index(name)])

    @property
    def target(self) -> float:
        """Norm of the torque's integrals."""
        return size(self.triangle.matrix[:, -1])


def _no_cause(*_: object) -> None:
    return None


@dataclass(frozen=True, slots=True, kw_only=True)
class Evidence:
    """Inputs shared by all warning checks: a fit and its data.

    Attributes
    ----------
    problem : Problem
        Recordings, joint and terms.
    penalty : Penalty
        Penalty over the windows that are used.
    best : ndarray
        The parameters found, in the order of `penalty.names`.
    residual : ndarray
        Window residuals of the penalty at these parameters.
    chance : mapping of str to float
        Part of each standard error that comes from random noise alone.
    torque_level : float
        Root mean square of the drive's torque [N·m or N].
    guessed_sign : bool
        Whether two signs of the gain fit almost equally well.
    inspections : tuple of Inspected
        Properties of the signals of each recording.
    at_best : Regressor
        Integrals at the estimated shape parameters.
    velocity_effect : VelocityEffect or None
        Effect of the velocity's noise on the parameters; None if it is harmless.
    own_noise : OwnNoise or None
        Effect of noise in the extra signals of own terms on the parameters; None if it is harmless.
    correlations : mapping
        Correlation of each pair of free parameters, offsets centered.
    delays : mapping of str to Delay
        Delays of the signals against the position.
    slow_motion : SlowMotion or None
        Disagreement of slow windows with faster ones.
    white : bool
        Whether the residuals are noise; this is tested on enough windows only.
    causes : Causes or None
        Causes of the residual; None if it is noise.
    cross_check : CrossCheck
        Cross-check of the values.
    torques : Torques
        Size of the torque of each coefficient.
    cause_of : callable
        Returns the effect of a cause on the values. Arguments: its name, its number in its kind, its share of the
        residual, and its size if that is known.
    """

    problem: Problem
    penalty: _core.Penalty
    best: Array
    residual: Array
    table: WindowTable
    parameters: Mapping[str, ParameterEstimate]
    chance: Mapping[str, float]
    residuals: ResidualStatistics
    torque_level: float
    status: str
    message: str
    bounds_from_data: tuple[str, ...]
    guessed_sign: bool
    inspections: tuple[Inspected, ...]
    at_best: Regressor
    correlations: Mapping[tuple[str, str], float]
    delays: Mapping[str, Delay]
    slow_motion: SlowMotion | None
    cross_check: CrossCheck
    torques: Torques
    velocity_effect: VelocityEffect | None = None
    own_noise: OwnNoise | None = None
    white: bool = False
    causes: Causes | None = None
    cause_of: Callable[..., Cause | None] = _no_cause

    @property
    def recordings(self) -> tuple[Recording, ...]:
        """Recordings used."""
        return self.problem.recordings

    @property
    def joint(self) -> Joint | None:
        """Joint before the identification."""
        return self.problem.joint

    @property
    def model(self) -> str:
        """Name of the friction model."""
        return self.problem.choice.model.resolved.name

    @property
    def undivided(self) -> tuple[Undivided, ...]:
        """Combinations of an offset and the difference of Coulomb frictions that the data do not separate."""
        return undivided(
            [p.name for p in self.parameters.values() if p.vary and p.at_bound is None]
        )

    @property
    def sensor_parameters(self) -> tuple[str, ...]:
        """Parameters of the torque sensor."""
        names = ("sensor_gain", "sensor_offset")
        return tuple(name for name in names if name in self.parameters)

    def regressor(self, best: Array | None = None) -> Regressor:
        """Return window integrals of all terms and of the target, at the estimated shapes or others [unit · s]."""
        if best is None:
            return self.at_best
        columns = self.penalty.linear_columns(best)
        return regressor(self.penalty, columns, self.problem.threads)


def regressor(penalty: _core.Penalty, columns: Array, threads: int) -> Regressor:
    """Return the triangular factor of the penalty's columns and target."""
    triangle = Triangle(np.column_stack([columns, penalty.target]), threads)
    return Regressor(names=tuple(penalty.names[: penalty.coefficients]), triangle=triangle)
