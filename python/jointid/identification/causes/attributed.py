"""A candidate that explains part of the residual, and its effect on the parameters."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from jointid.base.values import dataclass
from jointid.identification.causes.candidates import Candidate

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Attributed:
    """Candidate that explains part of the residual.

    Attributes
    ----------
    candidate : Candidate
    share : float
        Share of the held-out residual at the best scale.
    factor : int
        Best scale, as the number of neighboring windows in one sum.
    coefficients : ndarray, shape (m,)
        Coefficients of the candidate's columns.
    shifts : ndarray
        Change of the free parameters by this cause, in addition to the causes before it.
    alike : tuple of str
        Names of other families that explain nearly as much.
    """

    candidate: Candidate
    share: float
    factor: int
    coefficients: Array
    shifts: Array
    alike: tuple[str, ...] = ()
