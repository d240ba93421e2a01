"""Fit of a whole long recording, while its causes are found from stretches."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from jointid.identification.causes.attributed import Attributed
from jointid.identification.causes.events import LocalEvent, local_event
from jointid.identification.causes.families import same_candidate
from jointid.identification.causes.fitted_balance import FittedBalance


class WholeRecording:
    """Fit of a whole recording with the causes found so far.

    Parameters
    ----------
    fit : FittedBalance
        Fit over sums of neighboring windows of the whole recording.
    stretches : FittedBalance
        Fit over stretches of the recording.
    """

    def __init__(self, fit: FittedBalance, stretches: FittedBalance) -> None:
        self._fit = fit
        self._columns = fit.jacobian
        self._reached = np.zeros(fit.jacobian.shape[1])
        # By chance, the minimum of the stretches differs. This difference is not the shift of a cause.
        self._by_chance = stretches.solve(stretches.jacobian, stretches.residual)
        self._by_chance -= fit.solve(fit.jacobian, fit.residual)

    def event(self) -> LocalEvent | None:
        """Return an event that the causes found so far do not explain."""
        return local_event(self._fit, self._columns, self._fit.residual)

    def attributed(self, found: Attributed) -> Attributed:
        """Return a cause from the stretches, with size and shifts from the whole recording."""
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
