"""The form of the penalty that a search evaluates, and the check of its result against the direct sum."""

from __future__ import annotations

from dataclasses import field, replace

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.base.values import dataclass
from jointid.estimate.statistics import Convergence
from jointid.identification.search.domain import SearchDomain
from jointid.problem.inner_products import inner

Array = NDArray[np.float64]

# Largest error of the compressed penalty: as a share of the penalty, and of the target's square.
_RELATIVE, _ABSOLUTE = 1e-9, 1e-13
_KEPT = 50_000  # windows

# Penalty, residuals, their derivatives, and columns.
Balance = tuple[float, Array, Array, Array]


@dataclass(frozen=True, slots=True, kw_only=True)
class Outcome:
    """The result of a search; generations and evaluations are those before the polish.

    Attributes
    ----------
    balance : tuple or None
        The direct sum at `best`, where the search has verified itself by it over few windows.
    """

    best: Array
    convergence: Convergence | None
    status: str
    message: str
    generations: int = 0
    evaluations: int = 0
    balance: Balance | None = field(default=None, compare=False, repr=False)


@dataclass(frozen=True, slots=True, kw_only=True)
class Engine:
    """The penalty that a search evaluates: compressed if that is exact, else the direct sum.

    Attributes
    ----------
    direct : Penalty
        The sum over all samples; every result is verified against it.
    form : PenaltyFunction
        The penalty that the search evaluates.
    reason : str
        Why compression failed; empty otherwise.
    threads : int
        0: all.
    """

    direct: _core.Penalty
    form: _core.PenaltyFunction
    reason: str
    threads: int = 0

    @classmethod
    def of(cls, penalty: _core.Penalty, domain: SearchDomain, threads: int) -> Engine:
        """Return an engine; it compresses the penalty if that saves time and is exact but for rounding.

        Parameters
        ----------
        penalty : Penalty
        domain : SearchDomain
        threads : int
            0: all.
        """
        compressed = _core.CompressedPenalty(penalty, domain.lower, domain.upper, threads=threads)
        if compressed.exact:
            return cls(direct=penalty, form=compressed, reason="", threads=threads)
        return cls(direct=penalty, form=penalty, reason=compressed.reason, threads=threads)

    def polished(self, domain: SearchDomain, start: Array) -> tuple[Array, int, bool]:
        """Return the optimum over the shapes' ranges and near a start, the number of steps, and whether it converged.

        With one free shape and the direct sum: near the start only. Two shapes: by projection, where that is at
        least as good as the start.
        """
        shapes = free_shapes(self.direct, domain)
        if self.form is self.direct and shapes < 2:
            found = _core.polish(self.direct, domain.lower, domain.upper, start)
            return found.best, found.iterations, found.converged
        if shapes > 1:
            whole = _core.minimise_projected(
                self.direct, domain.lower, domain.upper, threads=self.threads
            ).found
            if whole is not None and whole.penalty <= self.form(start):
                return whole.best, whole.evaluations, True
        near = _core.refine_separable(
            self.form, domain.lower, domain.upper, start, threads=self.threads
        )
        if self.form is not self.direct:
            return near.best, near.evaluations, True
        last = _core.polish(self.direct, domain.lower, domain.upper, near.best)
        return last.best, near.evaluations + last.iterations, last.converged

    def verified(self, outcome: Outcome, domain: SearchDomain) -> Outcome:
        """Verify an outcome against the direct sum; where they disagree, return a polish by the direct sum."""
        if self.form is self.direct:
            because = f", by the direct sum because {self.reason}" if self.reason else ""
            return replace(outcome, message=outcome.message + because)
        best, direct = outcome.best, self.direct
        gain = 1.0
        if direct.residual == _core.Residual.sensor:
            gain = float(best[direct.names.index("sensor_gain")])
        # Of hours of motion the arrays are not kept beside all that follows.
        balance = direct.balance_at(best) if direct.window_count <= _KEPT else None
        expected = direct(best) if balance is None else balance[0]
        size = inner(direct.target, direct.target) / gain**2
        if abs(self.form(best) - expected) <= _RELATIVE * expected + _ABSOLUTE * size:
            return replace(outcome, balance=balance)
        found = _core.polish(direct, domain.lower, domain.upper, best)
        message = f"{outcome.message}, and a polish by the direct sum, which did not agree"
        return replace(outcome, best=found.best, message=message)


def free_shapes(penalty: _core.Penalty, domain: SearchDomain) -> int:
    """Return how many shapes are searched."""
    shapes = slice(penalty.coefficients, None)
    ranges = zip(domain.lower[shapes].tolist(), domain.upper[shapes].tolist(), strict=True)
    return sum(low < high for low, high in ranges)
