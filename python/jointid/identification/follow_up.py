"""Answers to questions about an estimate that need its recordings."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from jointid.base.errors import InputError

if TYPE_CHECKING:
    from jointid.estimate.causes import Causes
    from jointid.estimate.estimate import Estimate
    from jointid.identification.search.domain import SearchDomain
    from jointid.identification.search.search import Search
    from jointid.problem.problem import Problem
    from jointid.problem.windows import Windows


@dataclass(frozen=True, slots=True, kw_only=True)
class EstimateSource:
    """What an estimate was made from; it shares the recordings' arrays and keeps no array per window.

    Attributes
    ----------
    problem : Problem
    domain : SearchDomain
    windows : int, float, str, WindowOptions or None
        As given in the call.
    search : Search
    """

    problem: Problem
    domain: SearchDomain
    windows: Windows
    search: Search

    def causes(self, estimate: Estimate, signals: Mapping[str, ArrayLike] | None) -> Causes:
        """Attribute the misfit of the estimate.

        Raises
        ------
        InputError
            Several recordings with `signals`, or a signal with another number of values.
        """
        from jointid.identification.causes.causes import find_causes

        penalty = self.problem.penalty(self.windows)
        torque = np.asarray(penalty.target) / np.asarray(penalty.usable_duration)
        return find_causes(
            self.problem,
            penalty,
            estimate.parameters,
            torque_level=float(np.sqrt(np.mean(torque**2))),
            r_squared=estimate.residuals.r_squared,
            signals=self._checked(signals or {}),
        )

    def _checked(self, signals: Mapping[str, ArrayLike]) -> dict[str, NDArray[np.float64]]:
        if signals and len(self.problem.recordings) > 1:
            raise InputError(
                "further signals need an estimate of one recording",
                argument="signals",
                value=list(signals),
            )
        found = {}
        for name, values in signals.items():
            array = np.asarray(values, dtype=np.float64)
            if array.shape != (len(self.problem.recordings[0]),) or not np.all(np.isfinite(array)):
                raise InputError(
                    f"one finite value a sample of the recording is expected, {len(self.problem.recordings[0])}",
                    argument=f"signals.{name}",
                    value=f"shape {array.shape}",
                )
            found[name] = array
        return found

    def __reduce__(self) -> tuple[Callable[[], None], tuple[()]]:
        """Leave the recordings out of a pickled estimate."""
        return _nothing, ()


def _nothing() -> None:
    return None
