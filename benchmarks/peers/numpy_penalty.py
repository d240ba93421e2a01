"""The penalty in good NumPy code: everything that does not depend on the candidate is computed beforehand."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

import jointid as jid

Array = NDArray[np.float64]


class NumpyPenalty:
    """The window residuals of `well_excited`; parameters in the order of the compiled penalty.

    Parameters
    ----------
    recording : Recording
        With velocity, torque (held between samples) and sensor.
    inertia : float
        Output side [kg·m²].
    usable : array of bool, shape (samples - 1,)
        Intervals in which the joint moves.
    windows : array of int, shape (windows, 2)
        First and last sample of each window.
    names : sequence of str
        Order of the parameters.
    """

    def __init__(
        self,
        recording: jid.Recording,
        inertia: float,
        usable: NDArray[np.bool_],
        windows: NDArray[np.int64],
        names: list[str],
    ) -> None:
        assert recording.torque is not None
        assert recording.sensor is not None
        assert recording.velocity is not None
        time, speed = recording.time, recording.velocity
        count = len(windows)
        interval = np.concatenate([np.arange(first, last) for first, last in windows])
        window = np.repeat(np.arange(count), np.diff(windows, axis=1).ravel())
        keep = usable[interval]
        k, window = interval[keep], window[keep]
        step = np.diff(time)[k]

        def over_windows(values: Array) -> Array:
            return np.asarray(np.bincount(window, values, minlength=count), dtype=np.float64)

        def middle(values: Array) -> Array:
            return np.asarray(0.5 * (values[k] + values[k + 1]), dtype=np.float64)

        # Within an interval with a reversal, each sign holds up to the crossing on the straight line.
        v0, v1 = speed[k], speed[k + 1]
        crosses = v0 * v1 < 0.0
        part = np.where(crosses, np.abs(v0) / np.maximum(np.abs(v0) + np.abs(v1), 1e-300), 1.0)
        before = 0.5 * step * np.sign(v0) * part
        after = 0.5 * step * np.sign(v1) * np.where(crosses, 1.0 - part, 1.0)
        signs = over_windows(before + after)
        self._at_rest = over_windows(np.where(crosses, before + after, 0.0))
        # One weight per sample and window, so that each exponential is computed once.
        node = np.concatenate([window, window]) * (len(time) + 1) + np.concatenate([k, k + 1])
        nodes, place = np.unique(node, return_inverse=True)
        self._weight = np.bincount(place, np.concatenate([before, after]))
        self._square = speed[nodes % (len(time) + 1)] ** 2
        owners = nodes // (len(time) + 1)
        self._starts = np.searchsorted(owners, np.arange(count))

        self._balance = over_windows(recording.torque[k] * step) - inertia * over_windows(v1 - v0)
        self._sensed = over_windows(middle(recording.sensor) * step)
        position = recording.position
        columns = {
            "coulomb": signs,
            "viscous": over_windows(position[k + 1] - position[k]),
            "sensor_offset": over_windows(step),
        }
        self._linear = [names.index(name) for name in columns]
        self._columns = np.column_stack(list(columns.values()))
        self._static, self._shape = names.index("static"), names.index("stribeck")
        self._gain = names.index("sensor_gain")

    def residuals(self, theta: Array) -> Array:
        """Return the residuals of the windows for one candidate."""
        decay = self._weight * np.exp(-theta[self._shape] * self._square)
        column = np.add.reduceat(decay, self._starts) + self._at_rest
        modelled = self._columns @ theta[self._linear] + theta[self._static] * column
        result: Array = (self._balance - modelled) / theta[self._gain] - self._sensed
        return result

    def __call__(self, theta: Array) -> float:
        """Return the sum of squares."""
        r = self.residuals(theta)
        return float(r @ r)

    def many(self, candidates: Array) -> Array:
        """Return the penalties of candidates, shape (count, parameters)."""
        decay = np.exp(np.multiply.outer(-candidates[:, self._shape], self._square))
        decay *= self._weight
        column = np.add.reduceat(decay, self._starts, axis=1) + self._at_rest
        modelled = candidates[:, self._linear] @ self._columns.T
        modelled += candidates[:, [self._static]] * column
        r = (self._balance - modelled) / candidates[:, [self._gain]] - self._sensed
        return np.asarray(np.einsum("ij,ij->i", r, r), dtype=np.float64)
