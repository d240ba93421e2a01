"""Variable projection (Golub and Pereyra 1973): the penalty as a function of only the shapes, in NumPy.

The linear columns are decomposed once; a shape then costs its decaying column and a few products. Bounds are ignored:
the peer's user checks the answer.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

import jointid as jid
from jointid import _core

Array = NDArray[np.float64]
Decay = Callable[[Array], Array]


class Projection:
    """The penalty of some shapes with the best linear coefficients.

    Parameters
    ----------
    direct : Penalty
        Gives the columns that do not depend on the shapes, and the target.
    lower, upper : array, shape (parameters,)
        A coefficient with equal bounds is fixed.
    decay : callable
        Returns the one column that depends on the shapes, shape (windows,).
    """

    def __init__(self, direct: _core.Penalty, lower: Array, upper: Array, decay: Decay) -> None:
        count = direct.coefficients
        columns = np.asarray(direct.columns(np.asarray(upper[count:])))
        target = np.array(direct.target)
        constant, gain = [], None
        for j, name in enumerate(direct.names[:count]):
            if lower[j] == upper[j]:
                target -= lower[j] * columns[:, j]
            elif name == "sensor_gain" and direct.residual == _core.Residual.sensor:
                gain = columns[:, j]
            elif not name.startswith("static"):
                constant.append(columns[:, j])
        if gain is not None:  # linear in 1 / gain and coefficient / gain
            constant.append(target)
            target = gain
        self._basis = np.linalg.qr(np.column_stack(constant))[0]
        self._target = target - self._basis @ (self._basis.T @ target)
        self._square = float(self._target @ self._target)
        self._decay = decay
        self.evaluations = 0

    def __call__(self, shapes: Array) -> float:
        """Return the penalty of one candidate."""
        self.evaluations += 1
        column = self._decay(np.atleast_1d(shapes))
        column = column - self._basis @ (self._basis.T @ column)
        size = float(column @ column)
        along = float(column @ self._target)
        return self._square - along * along / size if size > 0.0 else self._square


def numpy_decay(
    recordings: Sequence[jid.Recording],
    usable: Sequence[NDArray[np.bool_]],
    windows: NDArray[np.int64],
    owner: Sequence[int],
) -> Decay:
    """Return the column of friction that decays with the speed; all that is possible is computed beforehand.

    Parameters
    ----------
    recordings : sequence of Recording
        With velocities.
    usable : sequence of array, shape (samples - 1,)
        Of each recording, the intervals in which the joint moves.
    windows : array of int, shape (windows, 2)
        First and last sample of each.
    owner : sequence of int
        The recording of each window.
    """
    speeds, weights, rows = [], [], []
    at_rest = np.zeros(len(windows))
    for i, recording in enumerate(recordings):
        assert recording.velocity is not None
        own = np.flatnonzero(np.asarray(owner) == i)
        interval = np.concatenate([np.arange(*windows[w]) for w in own])
        window = np.repeat(own, np.diff(windows[own], axis=1).ravel())
        keep = usable[i][interval]
        k, window = interval[keep], window[keep]
        step = np.diff(recording.time)[k]
        v0, v1 = recording.velocity[k], recording.velocity[k + 1]
        crosses = v0 * v1 < 0.0
        part = np.where(crosses, np.abs(v0) / np.maximum(np.abs(v0) + np.abs(v1), 1e-300), 1.0)
        before = 0.5 * step * np.sign(v0) * part
        after = 0.5 * step * np.sign(v1) * np.where(crosses, 1.0 - part, 1.0)
        at_rest += np.bincount(
            window, np.where(crosses, before + after, 0.0), minlength=len(windows)
        )
        count = len(recording.time) + 1
        node = np.concatenate([window, window]) * count + np.concatenate([k, k + 1])
        nodes, place = np.unique(node, return_inverse=True)
        weights.append(np.bincount(place, np.concatenate([before, after])))
        speeds.append(np.abs(recording.velocity[nodes % count]))
        rows.append(nodes // count)
    speed, weight, row = (np.concatenate(each) for each in (speeds, weights, rows))
    square = speed**2
    logarithm = np.log(np.maximum(speed, 1e-300))
    filled, starts = np.unique(row, return_index=True)

    def column(shapes: Array) -> Array:
        if len(shapes) == 1:
            decay = np.exp(-shapes[0] * square)
        else:
            decay = np.exp(-np.exp(shapes[1] * (logarithm - np.log(shapes[0]))))
        decay *= weight
        result = at_rest.copy()
        result[filled] += np.add.reduceat(decay, starts)
        return result

    return column


def compiled_decay(direct: _core.Penalty) -> Decay:
    """Return the same by our compiled direct sum."""
    place = next(j for j, name in enumerate(direct.names) if name.startswith("static"))
    return lambda shapes: np.asarray(direct.columns(shapes))[:, place]
