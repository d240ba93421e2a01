"""Variances that hold when windows of one segment hang together: the sandwich clustered over segments.

Each segment's scores are corrected for the freedom that the fit took from them (CR2: Bell and McCaffrey 2002;
Pustejovsky and Tipton 2018), and the quantile is that of Student's t with as many degrees of freedom as the segments
give a parameter (Satterthwaite), which is few where few segments determine it.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.base.values import dataclass
from jointid.identification.inference.segments import Segments
from jointid.problem.inner_products import inner

Array = NDArray[np.float64]

# Residuals that are white are refused as such in one of a hundred cases, by each of two tests.
_CERTAIN = 0.01
_CERTAIN_NORMAL = 2.326
_OPPOSED = 0.2  # correlation of neighbours; by their noise alone it is -0.5
# A parameter that fewer segments determine borrows the missing degrees of freedom from the others.
_FEWEST = 5.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Stretch:
    """By how much variances are larger than those of white residuals of one size.

    Attributes
    ----------
    ratio : ndarray, shape (p,)
    freedom : ndarray, shape (p,)
        Degrees of freedom behind each variance.
    white : bool
        Whether nothing in the residuals contradicts their independence.
    correlation : ndarray, shape (p, p), or None
        Of the parameters, by segments; None where the classical ones hold. Where few segments determine a
        parameter, the classical ones have as much weight as the freedom that it borrows.
    """

    ratio: Array
    freedom: Array
    white: bool
    correlation: Array | None = None


def stretch_of(jacobian: Array, residual: Array, whitening: Array, segments: Segments) -> Stretch:
    """Return how much larger variances are than the classical ones.

    Parameters
    ----------
    jacobian : ndarray, shape (windows, p)
    residual : ndarray, shape (windows,)
    whitening : ndarray, shape (r, p)
        Takes the scores of the r determined directions to unit variance: its own product,
        ``whitening.T @ whitening``, is the covariance for residuals of unit variance.
    segments : Segments

    Notes
    -----
    Where no test contradicts white residuals, the variance of each parameter is the larger of the classical one and
    that of clusters of one window (White's, which allows for noise that depends on the motion); else it is the mean
    of two clusterings over motion segments. tests/identification/test_covariance.py tests the coverage.
    """
    rows, directions = len(residual), len(whitening)
    freedom = max(1, rows - directions)
    variance = inner(residual, residual) / freedom
    unit = np.einsum("rp,rp->p", whitening, whitening)
    classical = np.where(unit * variance > 0.0, unit * variance, 1.0)
    known = Stretch(
        ratio=np.ones(unit.size), freedom=np.full(unit.size, float(freedom)), white=True
    )
    if directions == 0 or variance <= 0.0:
        return known
    clusterings, of_rows = _core.clustered(
        jacobian, residual, whitening, [cuts.tolist() for cuts in segments.cuts]
    )
    count = min(each.segments for each in clusterings)
    if count < 3:
        return known
    size = sum(each.size for each in clusterings) / len(clusterings)
    pooled = size / (directions * variance)
    pooled_freedom = sum(each.pooled_freedom for each in clusterings) / len(clusterings)
    if not _contradicted(residual, pooled, pooled_freedom):
        alone = np.asarray(of_rows) * rows / freedom
        return Stretch(
            ratio=np.maximum(alone / classical, 1.0),
            freedom=np.full(unit.size, float(freedom)),
            white=True,
        )
    covariance = np.mean([each.covariance for each in clusterings], axis=0)
    ratio = np.diag(covariance) / classical
    # One is lost to the mean that the fit took from each direction.
    own = np.maximum(np.mean([each.freedom for each in clusterings], axis=0) - 1.0, 1.0)
    borrowed = np.maximum(_FEWEST - own, 0.0)
    together = own + borrowed
    return Stretch(
        ratio=(own * ratio + borrowed * pooled) / together,
        freedom=together,
        white=False,
        correlation=_correlation(
            covariance,
            np.einsum("rp,rq->pq", whitening, whitening),
            float((own / together).min()),
        ),
    )


def _correlation(clustered: Array, classical: Array, weight: float) -> Array:
    """Mean of two matrices of correlations; with one weight for all pairs it is one, too."""
    both = []
    for matrix in (clustered, classical):
        size = np.sqrt(np.diag(matrix))
        size = np.where(size > 0.0, size, 1.0)
        both.append(matrix / np.outer(size, size))
    found = weight * both[0] + (1.0 - weight) * both[1]
    np.fill_diagonal(found, 1.0)
    return np.asarray(found)


def _contradicted(residual: Array, pooled: float, freedom: float) -> bool:
    """Whether neighbouring windows, or windows of a segment, agree more than independent ones would, or far less.

    What the velocity's noise adds to one window it takes from the next, and sums over a segment know it.
    """
    power = inner(residual, residual)
    neighbours = inner(residual[1:], residual[:-1]) / power
    freedom = max(freedom - 1.0, 1.0)
    limit = _core.chi_square_quantile(_CERTAIN, freedom) / freedom
    alike = neighbours * np.sqrt(len(residual))
    return alike > _CERTAIN_NORMAL or neighbours < -_OPPOSED or pooled > limit
