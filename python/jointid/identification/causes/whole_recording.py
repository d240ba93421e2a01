"""All of a long recording, beside the stretches of it that tell its causes."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from jointid.identification.causes.attributed import Attributed
from jointid.identification.causes.events import LocalEvent, local_event
from jointid.identification.causes.families import same_candidate
from jointid.identification.causes.fitted_balance import FittedBalance


class WholeRecording:
    """The fit of all of it, with the causes found so far.

    Parameters
    ----------
    fit : FittedBalance
        Sums of neighbouring windows.
    stretches : FittedBalance
        Some of the windows.
    """

    def __init__(self, fit: FittedBalance, stretches: FittedBalance) -> None:
        self._fit = fit
        self._columns = fit.jacobian
        self._reached = np.zeros(fit.jacobian.shape[1])
        # Stretches have a minimum of their own, by chance: it is no cause's shift.
        self._by_chance = stretches.solve(stretches.jacobian, stretches.residual)
        self._by_chance -= fit.solve(fit.jacobian, fit.residual)

    def event(self) -> LocalEvent | None:
        """An event that the causes found so far leave."""
        return local_event(self._fit, self._columns, self._fit.residual)

    def attributed(self, found: Attributed) -> Attributed:
        """A cause that stretches show, with the size and the shifts that all of the recording shows."""
        same, by_chance = same_candidate(self._fit, found.candidate), self._by_chance
        self._by_chance = np.zeros_like(by_chance)
        if same is None:
            shifts, coefficients = found.shifts - by_chance, found.coefficients
        else:
            self._columns = np.column_stack([self._columns, same.columns])
            solution = self._fit.solve(self._columns, self._fit.residual)
            shifts = solution[: len(self._reached)] - self._reached
            coefficients = -solution[-same.columns.shape[1] :]
        self._reached = self._reached + shifts
        return replace(found, shifts=shifts, coefficients=coefficients)
