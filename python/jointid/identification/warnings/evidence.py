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
    """The window integrals of all terms, then of the torque, as the triangle of a QR decomposition.

    Attributes
    ----------
    names : tuple of str
        Names of the coefficients.
    triangle : Triangle
    """

    names: tuple[str, ...]
    triangle: Triangle

    def norm(self, name: str) -> float:
        """Norm of a term's integrals."""
        return size(self.triangle.matrix[:, self.names.index(name)])

    @property
    def target(self) -> float:
        """Norm of the torque's integrals."""
        return size(self.triangle.matrix[:, -1])


def _no_cause(*_: object) -> None:
    return None


@dataclass(frozen=True, slots=True, kw_only=True)
class Evidence:
    """Inputs shared by all warning checks: a fit, and what it was made from.

    Attributes
    ----------
    problem : Problem
        Recordings, joint and terms.
    penalty : Penalty
        Over the windows used.
    best : ndarray
        The parameters found, in the order of `penalty.names`.
    residual : ndarray
        The penalty's window residuals there.
    chance : mapping of str to float
        The part of each standard error that chance explains.
    torque_level : float
        Root mean square of the drive's torque [N·m or N].
    guessed_sign : bool
        Whether the gain's sign is one of two that fit alike.
    inspections : tuple of Inspected
        Properties of the signals of each recording.
    at_best : Regressor
        At the estimated shape parameters.
    velocity_effect : VelocityEffect or None
        What the velocity's noise does to the parameters; None where it is harmless.
    own_noise : OwnNoise or None
        What the noise of the extra signals of own terms does to them; None where it is harmless.
    correlations : mapping
        Correlation of each pair of free parameters, offsets centered.
    delays : mapping of str to Delay
        Delays of the signals against the position.
    slow_motion : SlowMotion or None
        How slow windows disagree with faster ones.
    white : bool
        Whether the residuals are noise as far as enough windows can tell.
    causes : Causes or None
        Why the model does not fit; None where the residuals are noise.
    cross_check : CrossCheck
        The cross-check.
    torques : Torques
        How large the torque of each coefficient is.
    cause_of : callable
        Returns what a cause does to the values, from its name, which of its kind it is, the share of a misfit
        that it explains, and its size where that is known.
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
        """The joint before the identification."""
        return self.problem.joint

    @property
    def model(self) -> str:
        """Name of the friction model."""
        return self.problem.choice.model.resolved.name

    @property
    def undivided(self) -> tuple[Undivided, ...]:
        """Directions along which nothing tells an offset from the difference of Coulomb frictions."""
        return undivided(
            [p.name for p in self.parameters.values() if p.vary and p.at_bound is None]
        )

    @property
    def sensor_parameters(self) -> tuple[str, ...]:
        """Parameters of the torque sensor."""
        names = ("sensor_gain", "sensor_offset")
        return tuple(name for name in names if name in self.parameters)

    def regressor(self, best: Array | None = None) -> Regressor:
        """Window integrals of every term and of the target, at the estimated shape parameters or others [unit · s]."""
        if best is None:
            return self.at_best
        columns = self.penalty.linear_columns(best)
        return regressor(self.penalty, columns, self.problem.threads)


def regressor(penalty: _core.Penalty, columns: Array, threads: int) -> Regressor:
    """The triangle of the penalty's columns and target."""
    triangle = Triangle(np.column_stack([columns, penalty.target]), threads)
    return Regressor(names=tuple(penalty.names[: penalty.coefficients]), triangle=triangle)
