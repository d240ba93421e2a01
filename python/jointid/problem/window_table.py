"""The table of windows: measured and fitted integrals, and measures of their agreement."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from jointid.base.values import dataclass
from jointid.problem.inner_products import size

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False, repr=False)
class WindowTable:
    """Table with one row per window: integrals of the compared signal, and means for pictures.

    Attributes
    ----------
    recording : ndarray of int
        Index of the recording.
    start, stop : ndarray
        Start and end on the recording's clock [s].
    duration : ndarray
        Integrated time [s]; less than stop - start if samples were left out.
    measured, fitted : ndarray
        Integrals of the sensor reading, or of the torque [N·m·s].
    velocity : ndarray
        Mean velocity [rad/s or m/s].
    friction : ndarray
        Mean friction without load in the recording: torque minus all other fitted terms and load
        friction [N·m or N].
    """

    recording: NDArray[np.int64]
    start: Array
    stop: Array
    duration: Array
    measured: Array
    fitted: Array
    velocity: Array
    friction: Array

    def __repr__(self) -> str:
        return f"<WindowTable: {len(self.duration)} windows, {self.duration.sum():.4g} s in all>"

    @property
    def residual(self) -> Array:
        """Measured minus fitted integrals."""
        return self.measured - self.fitted


@dataclass(frozen=True, slots=True, kw_only=True, eq=False, repr=False)
class Prediction:
    """An estimate's prediction of a recording, which may be a new one.

    Attributes
    ----------
    windows : WindowTable
    relative : float
        Norm of the residuals over the norm of the measured integrals.
    r_squared : float
    """

    windows: WindowTable
    relative: float
    r_squared: float

    def __repr__(self) -> str:
        share = f"R² {self.r_squared:.5g}, relative residual {self.relative:.3g}"
        return f"<Prediction: {len(self.windows.duration)} windows, {share}>"


def r_squared(table: WindowTable) -> float:
    """Return R²: the explained share of the variance of the measured window means, weighted by duration.

    It compares means, because integrals of a constant signal vary with the duration of the windows.
    """
    time = float(table.duration.sum())
    level = float(table.measured.sum()) / time
    away = table.measured / table.duration - level
    residual = table.residual
    total = float((table.duration * away * away).sum())
    left = float((residual * residual / table.duration).sum())
    return 1.0 - left / total if total > 1e-18 * level**2 * time else 0.0


def relative_residual(table: WindowTable) -> float:
    """Return the norm of the residuals over the norm of the measured integrals; infinite if these are zero."""
    measured = size(table.measured)
    return size(table.residual) / measured if measured > 0.0 else float("inf")
