"""Effect of delays between signals on the parameters.

If a signal is late by d, its integral over a window lacks d times the change of the signal over the window. To first
order, this is the only effect of a delay on the balance.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.balance.covariance import Triangle
from jointid.problem.problem import Problem
from jointid.problem.recordings import output_torque
from jointid.recording.recording import Recording

Array = NDArray[np.float64]


def of_lags(
    problem: Problem,
    penalty: _core.Penalty,
    best: Array,
    jacobian: Array,
    lags: Mapping[str, float],
) -> Array:
    """Return the change of the free parameters when signals are late by `lags`.

    Parameters
    ----------
    jacobian : ndarray, shape (windows, free)
        Derivatives of the residuals by the free parameters.
    lags : mapping of str to float
        Uncertainty of the delay of each signal [s]: "torque", "sensor", "velocity".

    Returns
    -------
    ndarray, shape (free,)
        Root of the sum of squares over the signals.
    """
    names = list(penalty.names)
    gain = float(best[names.index("sensor_gain")]) if "sensor_gain" in names else 1.0
    # Converts a torque to the unit of the residual.
    scale = 1.0 / gain if penalty.residual == _core.Residual.sensor else 1.0

    def torque(run: Recording) -> Array:
        return output_torque(run, problem.joint)

    def sensor(run: Recording) -> Array:
        return np.zeros(len(run)) if run.sensor is None else -gain * run.sensor

    def velocity(run: Recording) -> Array:
        moved = np.zeros(len(run))
        for index, term in enumerate(penalty.terms):
            if term.friction and not term.needs_load:
                shapes = np.array([best[names.index(shape)] for shape in term.shapes])
                moved -= best[index] * _core.friction_basis(term.key, run.velocity, shapes, 0.0)
        if "inertia" in names:
            rate = np.gradient(run.velocity, run.sample_period)
            moved -= best[names.index("inertia")] * rate
        return moved

    signals: Mapping[str, Callable[[Recording], Array]] = {
        "torque": torque,
        "sensor": sensor,
        "velocity": velocity,
    }
    square = np.zeros(jacobian.shape[1])
    columns = list(range(jacobian.shape[1]))
    for signal, lag in lags.items():
        if lag == 0.0 or not columns:
            continue
        change = lag * scale * _changes(problem, penalty, signals[signal])
        both = Triangle(np.column_stack([jacobian, change]), problem.threads)
        square += both.solve(columns, len(columns), rcond=1e-10)[0] ** 2
    return np.sqrt(square)


def _changes(
    problem: Problem, penalty: _core.Penalty, signal: Callable[[Recording], Array]
) -> Array:
    """Return the change of a signal over each window."""
    bounds, run = np.asarray(penalty.windows), np.asarray(penalty.recording_of)
    result = np.empty(run.size)
    for number, recording in enumerate(problem.recordings):
        mine = slice(*np.searchsorted(run, (number, number + 1)))
        values = signal(recording)
        result[mine] = values[bounds[mine, 1]] - values[bounds[mine, 0]]
    return result
