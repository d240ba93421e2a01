"""A torque that passed a low-pass filter of first order, in place of one that is late: what held-out motion says.

Before such a filter the torque was y + T y'. Its integral over a window is that of y and T times the rise of y: one
more column, exact for any T. To first order a delay is the same column; they differ where the torque changes fast, as
at reversals.
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

_BETTER = 3.0  # standard errors by which held-out stretches fit better than with a delay
_SURE = 5.0  # standard errors of a time constant
_SMALL = 2e-4  # [s]; a shorter filter is left alone
_DIGITS = 7  # of seconds, as a call states them


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class TorqueLag:
    """Time constants of the torques' filters [s]; 0 of a torque without one."""

    values: Array  # (n,)
    errors: Array


def torque_lag_of(attempt: Attempt, delay: Array) -> TorqueLag | None:
    """Return filters that explain held-out motion better than delays [s]; None where none do.

    The attempt is one with the torques as recorded.
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
    """By how much each row's torque rises within its usable intervals."""
    found = np.empty(rows.kept.size)
    for piece, motion in attempt.excerpts.items():
        summing = attempt.balance.summings[piece]
        for joint in range(len(attempt.balance.places)):
            place = rows.places(piece, joint)
            rise = summing(joint, np.diff(motion.torque[joint]))
            found[place] = rise[rows.window[place]]
    return found
