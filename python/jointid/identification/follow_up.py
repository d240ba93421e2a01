"""Self-test, bootstrap and causes of an estimate, which need its recordings."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

from jointid.base.values import dataclass
from jointid.identification.gain import penalty_as_fitted

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from jointid.estimate.bootstrap import Bootstrap
    from jointid.estimate.causes import Cause, Causes
    from jointid.estimate.estimate import Estimate
    from jointid.estimate.record import EstimateRecord
    from jointid.estimate.self_test import SelfTest
    from jointid.identification.search.domain import SearchDomain
    from jointid.identification.search.search import Search
    from jointid.problem.problem import Problem
    from jointid.problem.windows import Windows
    from jointid.recording.recording import Recording


@dataclass(frozen=True, slots=True, kw_only=True)
class EstimateSource:
    """Input of an estimate. It shares the recordings' arrays and keeps no array per window.

    Attributes
    ----------
    problem : Problem
        Problem as fitted.
    given : tuple of Recording
        Recordings of the call. Those of `problem` may lack the samples at which a shifted signal is unknown.
    known : tuple of Cause
        Causes that were removed from the data before the fit.
    domain : SearchDomain
    windows : int, float, str, WindowOptions or None
        Windows of the call.
    search : Search
    again : callable
        Function that returns the estimate from other recordings, with the same settings.
    attributed : callable or None
        Function that returns the same estimate with the causes of its residual; None if it already has them.
    """

    problem: Problem
    given: tuple[Recording, ...]
    known: tuple[Cause, ...]
    domain: SearchDomain
    windows: Windows
    search: Search
    again: Callable[[tuple[Recording, ...]], Estimate]
    attributed: Callable[[], Estimate] | None = None

    def selftest(self, estimate: EstimateRecord, trials: int, seed: int) -> SelfTest:
        """Simulate known parameters in the recorded motion, and identify them again."""
        from jointid.identification.self_test.testing import self_test

        return self_test(
            self.problem, self.domain, self.windows, self.again, estimate, trials, seed
        )

    def bootstrap(self, estimate: EstimateRecord, n: int, seed: int) -> Bootstrap:
        """Resample blocks of the recordings, and refit the parameters to each sample."""
        penalty = penalty_as_fitted(self.problem, self.windows, self.domain)
        from jointid.identification.inference.bootstrap import block_bootstrap

        return block_bootstrap(self.problem, penalty, self.domain, estimate, n, seed)

    def causes(self, estimate: EstimateRecord, signals: Mapping[str, ArrayLike]) -> Causes:
        """Return the causes of the residual, after those that were removed before the fit."""
        from jointid.identification.causes.causes import attributed

        penalty = penalty_as_fitted(self.problem, self.windows, self.domain)
        times = self.given[0].time
        found = attributed(self.problem, penalty, estimate, signals, times)
        return replace(found, found=(*self.known, *found.found))

    def __reduce__(self) -> tuple[Callable[[], None], tuple[()]]:
        """Replace this object by None in a pickled estimate, so that it contains no recordings."""
        return _nothing, ()


def _nothing() -> None:
    return None
