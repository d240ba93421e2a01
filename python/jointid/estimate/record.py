"""The fields of an estimate, for all code that shows, judges, saves or uses them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from jointid.base.values import dataclass
from jointid.estimate.cross_check import CrossCheck
from jointid.estimate.delays import Delay
from jointid.estimate.findings import Finding
from jointid.estimate.selection import Selection
from jointid.estimate.slow_motion import SlowMotion
from jointid.estimate.statistics import Convergence, ParameterEstimate, ResidualStatistics
from jointid.problem.window_table import WindowTable

if TYPE_CHECKING:
    from jointid.estimate.bootstrap import Bootstrap
    from jointid.estimate.causes import Causes
    from jointid.estimate.self_test import SelfTest
    from jointid.joint.joint import Joint

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class EstimateRecord:
    """The fields of an `Estimate`; see its description."""

    parameters: Mapping[str, ParameterEstimate]
    free: tuple[str, ...]
    status: str
    message: str
    penalty: float
    correlation: Array
    condition: float
    weakest: tuple[str, ...]
    covariance: Array
    residuals: ResidualStatistics
    windows: WindowTable
    convergence: Convergence | None
    findings: tuple[Finding, ...]
    joint: Joint
    settings: Mapping[str, Any]
    seconds: float = field(repr=False)
    delays: Mapping[str, Delay] = field(default_factory=dict)
    slow_motion: SlowMotion | None = None
    selection: Selection | None = field(default=None, repr=False)
    information: Array | None = field(default=None, repr=False)
    cross_check: CrossCheck | None = field(default=None, repr=False)
    within: Mapping[str, float] = field(default_factory=dict, repr=False)
    follow_up: FollowUp | None = field(default=None, repr=False)

    @property
    def warnings(self) -> tuple[Finding, ...]:
        """Findings of severity "warning" or "blocking"."""
        return tuple(found for found in self.findings if found.severity != "info")


class FollowUp(Protocol):
    """Answers questions that need the recordings. `identify` adds it to its estimate; files do not contain it."""

    def selftest(self, estimate: EstimateRecord, trials: int, seed: int) -> SelfTest:
        """Answer `Estimate.selftest`."""
        ...

    def bootstrap(self, estimate: EstimateRecord, n: int, seed: int) -> Bootstrap:
        """Answer `Estimate.bootstrap`."""
        ...

    def causes(self, estimate: EstimateRecord, signals: Mapping[str, ArrayLike]) -> Causes:
        """Answer `Estimate.causes`."""
        ...
