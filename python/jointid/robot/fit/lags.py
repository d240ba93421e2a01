"""Detect a torque with a first-order low-pass filter instead of a delay, by held-out motion.

Before such a filter the torque was y + T y'. Its integral over a window is the integral of y plus T times the rise of
y. This is one more column, exact for any T. To first order a delay gives the same column. The two differ where the
torque changes fast, such as at reversals.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from jointid.robot.balance.products import FOLDS
from jointid.robot.fit.attempt import Attempt
from jointid.robot.fit.delays import ShiftedTorque
from jointid.robot.fit.excerpt_rows import ExcerptRows

Array = NDArray[np.float64]

# standard errors by which the residual of held-out stretches is below that with a delay
_BETTER = 3.0
_SURE = 5.0  # standard errors of a time constant
_SMALL = 2e-4  # [s]; a shorter filter is not undone
_DIGITS = 7  # decimal places of seconds in a call


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class TorqueLag:
    """Time constants of the torques' filters [s]; 0 for a torque without one."""

    values: Array  # (n,)
    errors: Array


def torque_lag_of(attempt: Attempt, delay: Array) -> TorqueLag | None:
    """Return filters that explain held-out motion better than delays [s]; None if there are none.

    `attempt` has the torques as recorded.
    """
    rows = ExcerptRows(attempt.balance, attempt.fit, attempt.excerpts)
    shifted = ShiftedTorque(attempt.excerpts, attempt.balance)
    mine = rows.joint[:, None] == np.arange(delay.size)
    of_delay = np.where(mine, (shifted(delay) - shifted(np.zeros_like(delay)))[:, None], 0.0)
    of_lag = np.where(mine, _rises(rows, attempt)[:, None], 0.0)
    as_lag, as_delay = rows.share(of_lag), rows.share(of_delay)
    gain = as_lag.gains - as_delay.gains
    values = np.round(-as_lag.values, _DIGITS)
    sure = (values > _SURE * as_lag.errors) & (values > _SMALL)
    better = float(gain.sum()) > _BETTER * float(np.std(gain, ddof=1)) * np.sqrt(FOLDS)
    if not better or np.any(delay[~sure]):
        return None
    return TorqueLag(values=np.where(sure, values, 0.0), errors=as_lag.errors)


def _rises(rows: ExcerptRows, attempt: Attempt) -> Array:
    """Return the rise of each row's torque within its usable intervals."""
    found = np.empty(rows.kept.size)
    for piece, motion in attempt.excerpts.items():
        summing = attempt.balance.summings[piece]
        for joint in range(len(attempt.balance.places)):
            place = rows.places(piece, joint)
            rise = summing(joint, np.diff(motion.torque[joint]))
            found[place] = rise[rows.window[place]]
    return found
