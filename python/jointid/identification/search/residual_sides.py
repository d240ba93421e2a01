"""Estimates by either side of the regression, which bracket the estimate by instruments."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from jointid import _core

Array = NDArray[np.float64]


def by_either_side(penalty: _core.Penalty, best: Array, free: Sequence[int]) -> dict[str, Array]:
    """Return all parameters by the residuals "sensor" and "torque", at the estimated shapes and without bounds.

    With the residual "torque", noise of the reading makes the gain too small. With "sensor", noise of the torque and
    friction that the model lacks make it too large. The differences from the estimate by instruments bound the effect
    of choosing a side. They are not errors of that estimate.

    Parameters
    ----------
    penalty : Penalty
        Penalty with a sensor gain among its coefficients.
    best : ndarray, shape (p,)
        All parameters, in the order of `penalty.names`.
    free : sequence of int
        Indices of the free parameters; shapes among them keep their values.

    Returns
    -------
    dict
        Parameters by residual; empty without a free gain, or if the windows do not determine the coefficients.
    """
    count = penalty.coefficients
    names = list(penalty.names[:count])
    gain = names.index("sensor_gain") if "sensor_gain" in names else -1
    if gain not in free:
        return {}
    linear = [i for i in free if i < count and i != gain]
    columns = penalty.columns(best[count:])
    rest = [i for i in range(count) if i not in free]
    target = penalty.target - np.einsum("ij,j->i", columns[:, rest], best[rest])
    sides = {
        "torque": (np.column_stack([columns[:, linear], columns[:, gain]]), target),
        "sensor": (np.column_stack([columns[:, linear], target]), columns[:, gain]),
    }
    result = {}
    for side, (matrix, wanted) in sides.items():
        whole = np.column_stack([matrix, wanted])
        sizes = np.linalg.norm(whole, axis=0)
        if not np.all(sizes > 0.0):
            return {}
        triangle = np.asarray(_core.triangle(whole / sizes))
        found, _, rank, _ = np.linalg.lstsq(triangle[:, :-1], triangle[:, -1], rcond=1e-10)
        if rank < matrix.shape[1] or found[-1] == 0.0:
            return {}
        found *= sizes[-1] / sizes[:-1]
        if side == "sensor":  # reading = torque / gain - other terms / gain
            found = np.append(-found[:-1] / found[-1], 1.0 / found[-1])
        values = best.copy()
        values[[*linear, gain]] = found
        result[side] = values
    return result
