"""Fields of a robot's estimate, without its methods."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from jointid.estimate.findings import Finding
from jointid.estimate.statistics import ParameterEstimate, ResidualStatistics
from jointid.problem.window_table import WindowTable
from jointid.robot.links.robot import Robot
from jointid.robot.result.bootstrap import RobotDraws
from jointid.robot.result.cross_check import CrossCheck

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class RobotJoint:
    """One joint of a robot's estimate.

    Attributes
    ----------
    name : str
    model : str
        For example "coulomb_viscous" or "stribeck:asymmetric".
    parameters : mapping of str to ParameterEstimate
        Parameters at the joint: those of its model, such as "coulomb" and "viscous", and "torque_offset".
        "motor_coulomb" and "motor_viscous" if its motor turns with several joints, "rotor_inertia" if it is identified,
        "inertia_scale" with ``inertia="scaled"``.
    residuals : ResidualStatistics
    windows : WindowTable
        `friction` of the windows is the torque minus everything except this joint's friction.
    """

    name: str
    model: str
    parameters: Mapping[str, ParameterEstimate]
    residuals: ResidualStatistics
    windows: WindowTable

    @property
    def relative_residual(self) -> float:
        """Norm of the residuals over the norm of the measured integrals."""
        return self.residuals.relative


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class RobotEstimateRecord:
    """Fields of a `RobotEstimate`, which documents them."""

    joints: Mapping[str, RobotJoint]
    inertia: str
    base_parameters: Mapping[str, ParameterEstimate]
    inertial: Array
    consistent: bool | None
    relative_residual: float
    free: tuple[str, ...]
    covariance: Array
    condition: float
    findings: tuple[Finding, ...]
    robot: Robot = field(repr=False)
    settings: Mapping[str, Any] = field(repr=False)
    seconds: float = field(default=0.0, repr=False)
    draws: RobotDraws | None = field(default=None, repr=False)
    impossible_by: float = 0.0
    cross_check: CrossCheck | None = None
    within: Mapping[str, float] = field(default_factory=dict)

    @property
    def parameters(self) -> dict[str, ParameterEstimate]:
        """All parameters by name: "joint.name" as in `free`, or the combination of a base parameter."""
        of_joints = {
            f"{joint.name}.{name}": p
            for joint in self.joints.values()
            for name, p in joint.parameters.items()
        }
        return {**of_joints, **self.base_parameters}

    @property
    def warnings(self) -> tuple[Finding, ...]:
        """Findings of severity "warning" or "blocking"."""
        return tuple(found for found in self.findings if found.severity != "info")
