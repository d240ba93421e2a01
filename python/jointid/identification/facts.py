"""What warnings are drawn from."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.estimate.findings import ParameterEstimate, ResidualStatistics, WindowTable
from jointid.identification.inspection import Inspected
from jointid.identification.problem import Problem
from jointid.joint.joint import Joint
from jointid.recording.recording import Recording

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True)
class Facts:
    """An estimate in the making, and where it came from.

    Attributes
    ----------
    problem : Problem
        Recordings, joint and terms.
    penalty : Penalty
        Over the windows used.
    best : ndarray
        The parameters found, in the order of `penalty.names`.
    chance : mapping of str to float
        The part of each standard error that chance explains.
    torque_level : float
        Root mean square of the drive's torque [N·m or N].
    inspections : tuple of Inspected
        What each recording shows by itself.
    correlations : mapping
        Of each pair of free parameters, offsets centred.
    """

    problem: Problem
    penalty: _core.Penalty
    best: Array
    table: WindowTable
    parameters: Mapping[str, ParameterEstimate]
    chance: Mapping[str, float]
    residuals: ResidualStatistics
    torque_level: float
    status: str
    message: str
    bounds_from_data: tuple[str, ...]
    inspections: tuple[Inspected, ...]
    correlations: Mapping[tuple[str, str], float]

    @property
    def recordings(self) -> tuple[Recording, ...]:
        """What was identified from."""
        return self.problem.recordings

    @property
    def joint(self) -> Joint | None:
        """The joint as it was given."""
        return self.problem.joint

    @property
    def model(self) -> str:
        """Name of the friction model."""
        return self.problem.choice.model

    def columns(self, best: Array | None = None) -> dict[str, Array]:
        """Window integrals of every term, at the shapes found or others, by name [the term's unit · s]."""
        count = self.penalty.coefficients
        found = self.penalty.columns((self.best if best is None else best)[count:])
        return {name: found[:, i] for i, name in enumerate(self.penalty.names[:count])}
