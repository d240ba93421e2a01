"""Shift of one signal that fits a balance in smooth windows best."""

from __future__ import annotations

from dataclasses import field
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.base.values import dataclass

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class Balance:
    """Rows of a balance, in which a signal's window means are a linear combination of columns.

    Attributes
    ----------
    windows : list of _core.SmoothWindows
        Windows of each stretch.
    signals : list of ndarray
        Samples of the signal in each stretch.
    columns : list of ndarray, each of shape (windows, columns)
        Columns over the used windows of each stretch.
    conservative : int
        Number of columns without friction; they come first.
    held : bool
        Whether the signal is held between samples. A sample then belongs to the middle of the interval.
    """

    windows: list[_core.SmoothWindows]
    signals: list[Array]
    columns: list[Array]
    conservative: int
    held: bool

    @cached_property
    def matrix(self) -> Array:
        """Columns over the windows of all stretches, one stretch after the other."""
        return self.columns[0] if len(self.columns) == 1 else np.concatenate(self.columns)


@dataclass(frozen=True, kw_only=True)
class Shift:
    """Delay of a signal.

    Attributes
    ----------
    value, stderr : float
        Delay and its standard error [s].
    conservative, friction : tuple of float
        Delay and standard error from each part of the signal alone [s]: the part without friction, and friction.
        Without friction both are equal.
    unexplained : float
        Share of the signal's variance that the columns do not explain.
    leading : float or None
        Result of `leading_coefficient`, if the fit computed it.
    """

    value: float
    stderr: float
    conservative: tuple[float, float]
    friction: tuple[float, float]
    unexplained: float
    leading: float | None = field(default=None, compare=False, repr=False)

    def agrees(self, other: Shift, share: float) -> bool:
        """Return whether another estimate is within three standard errors or a share of this delay."""
        apart = abs(self.value - other.value)
        errors = 3.0 * float(np.hypot(self.stderr, other.stderr))
        return apart <= max(errors, share * abs(self.value))

    def is_of_all(self, share: float) -> bool:
        """Return whether both parts of the signal show the same delay."""
        apart = abs(self.conservative[0] - self.friction[0])
        errors = 3.0 * float(np.hypot(self.conservative[1], self.friction[1]))
        return apart <= max(errors, share * abs(self.value))


def fit_shift(
    balance: Balance, *, reach: float = 0.0, robust: bool = True, least: float = 0.0
) -> Shift | None:
    """Return the delay of the balance's signal; None if the rows are too few or contain no information.

    The shifted window means of the signal are regressed on the columns and on their own rate of change. This rate comes
    from the fitted columns. It is an instrument without the signal's noise, so neither noise nor interpolation
    biases the delay to a whole or half sample.

    Parameters
    ----------
    balance : Balance
    reach : float
        Longest shift in a search for the smallest residual, from which the fit starts [s]. Default 0: start from no
        shift.
    robust : bool
        Whether windows with a large residual get a smaller weight. Default True.
    least : float
        Shortest delay of interest [s]. A delay that is clearly shorter after one step is not refined. Default 0.
    """
    found = _core.fit_shift(
        balance.windows,
        balance.signals,
        balance.matrix,
        conservative=balance.conservative,
        held=balance.held,
        reach=reach,
        robust=robust,
        least=least,
    )
    if found is None:
        return None
    value, stderr = found.whole
    conservative, error = found.conservative
    friction, other = found.friction
    return Shift(
        value=value,
        stderr=stderr,
        conservative=(conservative, error),
        friction=(friction, other),
        unexplained=found.unexplained,
        leading=found.leading,
    )


def leading_coefficient(balance: Balance) -> float:
    """Return the coefficient of the first column in a least-squares fit of the unshifted signal."""
    return _core.leading_coefficient(
        balance.windows, balance.signals, balance.matrix, held=balance.held
    )
