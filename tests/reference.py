"""An independent window least squares in plain NumPy: same model, mask and windows as the core, other code."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class LinearFit:
    """Coefficients with classical standard errors."""

    values: Array
    stderr: Array


def friction_integral(time: Array, velocity: Array) -> Array:
    """Integral of sgn v over each sample interval; a reversal is placed by linear interpolation."""
    step = np.diff(time)
    before, after = velocity[:-1], velocity[1:]
    result = 0.5 * (np.sign(before) + np.sign(after)) * step
    reversal = before * after < 0
    share = np.abs(before[reversal]) / (np.abs(before[reversal]) + np.abs(after[reversal]))
    result[reversal] = step[reversal] * (
        np.sign(before[reversal]) * share + np.sign(after[reversal]) * (1 - share)
    )
    return result


def window_sums(values: Array, usable: NDArray[np.bool_], bounds: NDArray[np.int64]) -> Array:
    """Sums over usable intervals of each window [begin, end)."""
    total = np.concatenate([[0.0], np.cumsum(np.where(usable, values, 0.0))])
    return np.asarray(total[bounds[:, 1]] - total[bounds[:, 0]])


def window_least_squares(
    time: Array,
    position: Array,
    velocity: Array,
    torque: Array,
    usable: NDArray[np.bool_],
    bounds: NDArray[np.int64],
) -> LinearFit:
    """Inertia, Coulomb, viscous and offset by ordinary least squares over window integrals (torque measured)."""
    step = np.diff(time)

    def over_windows(values: Array) -> Array:
        return window_sums(values, usable, bounds)

    target = over_windows(0.5 * (torque[1:] + torque[:-1]) * step)
    columns = np.column_stack(
        [
            over_windows(np.diff(velocity)),
            over_windows(friction_integral(time, velocity)),
            over_windows(np.diff(position)),
            over_windows(step),
        ]
    )
    values, *_ = np.linalg.lstsq(columns, target, rcond=None)
    residual = target - columns @ values
    variance = residual @ residual / (len(target) - columns.shape[1])
    stderr = np.sqrt(variance * np.diag(np.linalg.inv(columns.T @ columns)))
    return LinearFit(values=np.asarray(values, dtype=np.float64), stderr=stderr)
