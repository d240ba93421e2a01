"""The shift of one signal that a balance under smooth windows asks for."""

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
    """Rows of a balance: a signal's window means are a sum of columns.

    Attributes
    ----------
    windows : list of _core.SmoothWindows
        Windows of each stretch.
    signals : list of ndarray
        The signal of each stretch, sample by sample.
    columns : list of ndarray, each of shape (windows, columns)
        Over the used windows of each stretch.
    conservative : int
        Number of columns, the first ones, that have nothing to do with friction.
    held : bool
        Whether the signal is held between samples: it then stands for the middle of the interval.
    """

    windows: list[_core.SmoothWindows]
    signals: list[Array]
    columns: list[Array]
    conservative: int
    held: bool

    @cached_property
    def matrix(self) -> Array:
        """The columns over the windows of all stretches in turn."""
        return self.columns[0] if len(self.columns) == 1 else np.concatenate(self.columns)


@dataclass(frozen=True, kw_only=True)
class Shift:
    """The delay of a signal.

    Attributes
    ----------
    value, stderr : float
        [s]
    conservative, friction : tuple of float
        Value and standard error that each part of the signal asks for by itself [s]: what has nothing to
        do with friction, and friction. Without friction the first only, twice.
    unexplained : float
        Variance that the columns leave, over that of the signal.
    leading : float or None
        As `leading_coefficient` returns it, where that was a step on the way.
    """

    value: float
    stderr: float
    conservative: tuple[float, float]
    friction: tuple[float, float]
    unexplained: float
    leading: float | None = field(default=None, compare=False, repr=False)

    def agrees(self, other: Shift, share: float) -> bool:
        """Whether another estimate is within three standard errors or a share of this delay."""
        apart = abs(self.value - other.value)
        errors = 3.0 * float(np.hypot(self.stderr, other.stderr))
        return apart <= max(errors, share * abs(self.value))

    def is_of_all(self, share: float) -> bool:
        """Whether both parts of the signal ask for the same delay."""
        apart = abs(self.conservative[0] - self.friction[0])
        errors = 3.0 * float(np.hypot(self.conservative[1], self.friction[1]))
        return apart <= max(errors, share * abs(self.value))


def fit_shift(
    balance: Balance, *, reach: float = 0.0, robust: bool = True, least: float = 0.0
) -> Shift | None:
    """Return the delay of the balance's signal; None where the rows are too few or say nothing.

    The signal's window means, shifted, are regressed on the columns and on their own rate of change, which
    is taken from the fitted columns: an instrument without the signal's noise, so that neither that noise
    nor the interpolation pulls the delay to a whole or a half sample.

    Parameters
    ----------
    balance : Balance
    reach : float
        Search from the shift of least misfit up to this [s]. Default 0: from no shift.
    robust : bool
        Whether windows that miss by far count for less. Default True.
    least : float
        A delay that is clearly shorter after one step is not refined [s]. Default 0.
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
    """Of the first column, in least squares of the signal, not shifted, on the columns."""
    return _core.leading_coefficient(
        balance.windows, balance.signals, balance.matrix, held=balance.held
    )
