"""Residual in slow motion that no simple low-speed friction predicts."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from jointid.base.values import dataclass
from jointid.identification.causes.fitted_balance import FittedBalance
from jointid.recording.order_statistics import quantile

Array = NDArray[np.float64]

_SLOW = 0.2  # share of the windows that count as slow
_MOST = 0.85  # smallest share of the residual in them
_PLACES, _EACH = 3, 0.6  # fewest passages, and largest share of the residual in one of them


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class SlowRows:
    """Windows of slow motion with most of the residual.

    Attributes
    ----------
    rows : ndarray of bool, shape (windows,)
        Slow windows.
    share : float
        Share of the squared residual in these windows.
    speed : float
        Speed below which a window counts as slow [rad/s or m/s].
    """

    rows: NDArray[np.bool_]
    share: float
    speed: float


def slow_rows(fit: FittedBalance, base: Array, residual: Array) -> SlowRows | None:
    """Return the slow windows if they have most of the residual, in several passages; otherwise None."""
    velocity = fit.integral_of_each(lambda _, run: np.abs(run.velocity)) / fit.duration
    speed = quantile(velocity, _SLOW)
    rows = velocity < speed
    steps = fit.solve(base, residual)
    steps[: len(fit.start)] -= fit.start
    power = (residual + base @ steps) ** 2
    begins = np.concatenate([[True], ~rows[:-1] | (np.diff(fit.neighbours) != 0)])
    passage = np.cumsum(rows & begins)
    held = np.bincount(passage[rows], weights=power[rows])
    total = float(power.sum())
    share = float(held.sum()) / max(total, 1e-300)
    loud = np.count_nonzero(held > 0.02 * total)
    if share < _MOST or loud < _PLACES or float(held.max()) > _EACH * total:
        return None
    return SlowRows(rows=rows, share=share, speed=speed)
