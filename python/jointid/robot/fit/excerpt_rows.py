"""Weighted rows of some pieces of a recording, and the part of them that a fit's parameters cannot follow."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from jointid.robot.balance.balance import Balance
from jointid.robot.balance.fit import Fit
from jointid.robot.balance.products import FOLDS

Array = NDArray[np.float64]
Whole = NDArray[np.int64]

_CLUSTER = 0.3  # [s] of motion that counts as one observation
_SINGULAR = 1e-11  # of the largest eigenvalue of the scaled normal equations
_NOTHING = 1e-6  # of a column: smaller remainders are rounding


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Share:
    """Result of a few further columns."""

    # explained share of the weighted squared residuals; each stretch is predicted from the others
    share: float
    certainty: float  # this share over its standard error, from the scatter over the stretches
    values: Array  # (columns,); 0 for a column that the parameters follow
    # clustered over stretches of motion; infinite for a column that the parameters follow
    errors: Array
    gains: Array  # (FOLDS,), fall in each stretch
    wald: float  # squared values over squared errors, per column: 1 by chance


class ExcerptRows:
    """Rows of some pieces of a balance and its fit; with `free`, parameters at a bound may leave it."""

    def __init__(
        self, balance: Balance, fit: Fit, pieces: Collection[int], free: bool = False
    ) -> None:
        rows = balance.rows
        self.kept: Whole = np.flatnonzero(np.isin(rows.piece, list(pieces)))
        self.joint, self.piece = rows.joint[self.kept], rows.piece[self.kept]
        self.window = rows.window[self.kept]
        self.weight = 1.0 / fit.scatter[self.joint]
        used = np.flatnonzero(~fit.at_bound | free)
        known = fit.jacobian[np.ix_(self.kept, used)] * self.weight[:, None]
        lengths = np.sqrt(np.einsum("ij,ij->j", known, known))
        self._known = known[:, lengths > 0.0] / lengths[lengths > 0.0]
        values, vectors = np.linalg.eigh(self._known.T @ self._known)
        clear = values > _SINGULAR * values[-1]
        self._inverse = (vectors[:, clear] / values[clear]) @ vectors[:, clear].T
        self.residual = self.rest(fit.residual[self.kept])
        count = (rows.start[self.kept] // _CLUSTER).astype(np.int64)
        keys = self.piece * (int(count.max(initial=0)) + 1) + count
        self.cluster: Whole = np.unique(keys, return_inverse=True)[1]
        self._fold = np.arange(self.kept.size) * FOLDS // max(self.kept.size, 1)

    def places(self, piece: int, joint: int) -> Whole:
        """Return the positions of a joint's rows in a piece."""
        return np.flatnonzero((self.piece == piece) & (self.joint == joint))

    def rest(self, values: Array) -> Array:
        """Return weighted values (rows, or rows and columns) without the part that the parameters follow."""
        weight = self.weight if values.ndim == 1 else self.weight[:, None]
        scaled = values * weight
        return np.asarray(scaled - self._known @ (self._inverse @ (self._known.T @ scaled)))

    def share(self, columns: Array) -> Share:
        """Return the share of the residual that further columns, (rows, columns), explain."""
        raw = np.linalg.norm(columns * self.weight[:, None], axis=0)
        rest = self.rest(columns)
        lengths = np.linalg.norm(rest, axis=0)
        seen = (lengths > _NOTHING * raw) & (raw > _NOTHING * raw.max(initial=0.0))
        values, errors = np.zeros(raw.size), np.full(raw.size, np.inf)
        if not seen.any():
            return Share(
                share=0.0,
                certainty=0.0,
                values=values,
                errors=errors,
                gains=np.zeros(FOLDS),
                wald=0.0,
            )
        unit, edges = rest[:, seen] / lengths[seen], np.searchsorted(self._fold, np.arange(FOLDS))
        gram = np.array([part.T @ part for part in np.split(unit, edges[1:])])
        push = np.add.reduceat(unit * self.residual[:, None], edges, axis=0)
        gain = np.empty(FOLDS)
        for fold in range(FOLDS):
            others = np.linalg.pinv(gram.sum(axis=0) - gram[fold], rcond=1e-9, hermitian=True)
            found = others @ (push.sum(axis=0) - push[fold])
            gain[fold] = 2.0 * found @ push[fold] - found @ gram[fold] @ found
        inverse = np.linalg.pinv(gram.sum(axis=0), rcond=1e-9, hermitian=True)
        found = inverse @ push.sum(axis=0)
        scores = unit * (self.residual - unit @ found)[:, None]
        sums = np.column_stack([np.bincount(self.cluster, column) for column in scores.T])
        covariance = inverse @ (sums.T @ sums) @ inverse
        values[seen] = found / lengths[seen]
        errors[seen] = np.sqrt(np.diag(covariance)) / lengths[seen]
        wald = found @ np.linalg.pinv(covariance, rcond=1e-9, hermitian=True) @ found
        scatter = float(np.std(gain, ddof=1)) * np.sqrt(FOLDS)
        return Share(
            share=float(gain.sum() / max(self.residual @ self.residual, 1e-300)),
            certainty=float(gain.sum() / max(scatter, 1e-300)),
            values=values,
            errors=errors,
            gains=gain,
            wald=float(wald) / int(seen.sum()),
        )
