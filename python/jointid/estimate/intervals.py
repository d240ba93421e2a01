"""Intervals of quantities that follow from several parameters."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from jointid.estimate.estimate import Estimate

Array = NDArray[np.float64]

_NORMAL = 1.959964
_TINY = 1e-100  # a file may hold any number


def squared_half_widths(estimate: Estimate) -> Array:
    """Return the covariance of the free parameters, scaled so that its diagonal holds squared half widths.

    Each parameter's interval has its own quantile and its own systematic part; the correlations are those of the
    covariance.
    """
    scale = np.full(len(estimate.free), _NORMAL)
    for i, name in enumerate(estimate.free):
        p = estimate.parameters[name]
        if p.interval is not None and p.stderr is not None and _TINY < p.stderr < np.inf:
            scale[i] = 0.5 * (p.interval[1] - p.interval[0]) / p.stderr
        elif p.stderr == np.inf:
            scale[i] = 0.0
    # Of what no recording divides only sums are known; they are as uncertain as the others at most.
    scale[scale == 0.0] = scale.max(initial=_NORMAL)
    return np.asarray(estimate.covariance * np.outer(scale, scale))
