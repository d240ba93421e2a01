"""A candidate that explains part of a misfit, and what it does to the values."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from jointid.base.values import dataclass
from jointid.identification.causes.candidates import Candidate

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Attributed:
    """A candidate that explains part of the misfit.

    Attributes
    ----------
    candidate : Candidate
    share : float
        Share of the residual at its best scale, out of sample.
    factor : int
        That scale: neighbouring windows summed.
    coefficients : ndarray, shape (m,)
        Coefficients of its columns.
    shifts : ndarray
        Change of the free parameters by this cause, after those found before it.
    alike : tuple of str
        Names of other families that explain nearly as much.
    """

    candidate: Candidate
    share: float
    factor: int
    coefficients: Array
    shifts: Array
    alike: tuple[str, ...] = ()
