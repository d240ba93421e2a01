"""Fields of a servo's estimate, without its methods."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field

import numpy as np
from numpy.typing import NDArray

from jointid.base.errors import InputError
from jointid.base.values import dataclass
from jointid.estimate.findings import Finding
from jointid.estimate.statistics import ParameterEstimate
from jointid.joint.checks import suggestion
from jointid.joint.joint import Joint

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ServoEstimateRecord:
    """Fields of a `ServoEstimate`, which documents them."""

    joint: Joint
    parameters: Mapping[str, ParameterEstimate]
    findings: tuple[Finding, ...]
    model: str
    values: Array = field(repr=False)
    draws: Array = field(repr=False)
    load_friction: bool
    separable: bool
    lead: float
    lead_found: bool
    command_lag: float | None
    windows: int
    window: float
    slowest: float
    runs: tuple[str, ...]
    moving: tuple[float, ...] = field(repr=False)
    rms: float
    relative_residual: float
    seconds: float

    @property
    def warnings(self) -> tuple[Finding, ...]:
        """Findings of severity "warning" or "blocking"."""
        return tuple(each for each in self.findings if each.severity != "info")

    def __getitem__(self, name: str) -> float:
        """Return a parameter's value.

        Raises
        ------
        InputError
            There is no such parameter.
        """
        if name not in self.parameters:
            raise InputError(
                f"there is no such parameter; {suggestion(name, list(self.parameters))}",
                argument="name",
                value=name,
            )
        return self.parameters[name].value
