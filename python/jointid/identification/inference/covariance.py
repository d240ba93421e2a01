"""Uncertainty of a least-squares estimate: covariance, correlations and the least determined direction."""

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.base.values import dataclass
from jointid.identification.inference.clustered import stretch_of
from jointid.identification.inference.segments import Segments, even_segments
from jointid.problem.inner_products import column_sizes, inner
from jointid.problem.least_squares import solve

Array = NDArray[np.float64]

_EXACT = 1e-40  # noise of a fit without residuals
_SINGULAR = 1e-10  # smallest eigenvalue of correlations that are inverted


@dataclass(frozen=True, slots=True, kw_only=True)
class Covariance:
    """Covariance and related numbers of an estimate.

    Attributes
    ----------
    matrix : ndarray, shape (p, p)
        Covariance of the parameters, in the product of their units.
    information : ndarray, shape (p, p)
        Its inverse; where the data do not determine a direction, the information is zero along it.
    stderr : ndarray, shape (p,)
        Standard errors.
    freedom : ndarray, shape (p,)
        Degrees of freedom of Student's t, for the intervals.
    white : bool
        Whether nothing in the residuals contradicts their independence.
    correlation : ndarray, shape (p, p)
        Correlations after centring: the offset is referred to the mean of the signal that the gain
        multiplies, because the raw correlation depends on the sensor's arbitrary zero.
    condition : float
        Condition number of the centred Jacobian with columns of unit norm.
    weakest : ndarray, shape (p,)
        Unit vector, in those scaled columns, of the least determined direction.
    """

    matrix: Array
    information: Array
    stderr: Array
    freedom: Array
    white: bool
    correlation: Array
    condition: float
    weakest: Array


class Triangle:
    """R of the QR decomposition of a tall matrix, computed in one pass: all that least squares needs.

    Parameters
    ----------
    matrix : ndarray, shape (rows, columns)
    threads : int
        0: all.
    """

    def __init__(self, matrix: Array, threads: int = 0) -> None:
        self.matrix: Array = _core.triangle(matrix, threads=threads)

    def solve(self, columns: list[int], target: int, rcond: float) -> tuple[Array, float]:
        """Return the least-squares coefficients of some columns for another one, and the norm of the residual."""
        return solve(self.matrix, columns, target, rcond)


def parameter_covariance(
    jacobian: Array,
    residual: Array,
    centre: tuple[int, int, float] | None,
    triangle: Array | None = None,
    threads: int = 0,
    segments: Segments | None = None,
) -> Covariance:
    """Return the covariance of a least-squares estimate, by motion segments where residuals hang together.

    Parameters
    ----------
    jacobian : ndarray, shape (windows, p)
        Derivatives of the residuals by the free parameters.
    residual : ndarray, shape (windows,)
        Residuals at the minimum.
    centre : (gain, offset, mean) or None
        Columns of a gain and of its offset, and the mean of the signal that the gain multiplies.
    triangle : ndarray, shape (rows, p), optional
        Triangle of the Jacobian. Default: computed here.

    segments : Segments, optional
        Segments of motion. Default: sixteen of equal numbers of windows.

    Notes
    -----
    The residuals of an imperfect model drift slowly, and the classical variance is too small then:
    `clustered` says by how much, and how parameters go together. Directions that the data do not determine
    get an infinite variance.
    """
    rows, count = jacobian.shape
    if count == 0:  # every parameter is fixed or ended on a bound
        nothing = np.zeros((0, 0))
        return Covariance(
            matrix=nothing,
            information=nothing,
            stderr=np.zeros(0),
            freedom=np.zeros(0),
            white=True,
            correlation=nothing,
            condition=1.0,
            weakest=np.zeros(0),
        )
    if triangle is None:
        triangle = Triangle(jacobian, threads).matrix
    norms = column_sizes(triangle)
    scale = np.where(norms > 0.0, norms, 1.0)
    _, singular, directions = np.linalg.svd(triangle / scale, full_matrices=False)
    known = singular > 1e-10 * singular[0]
    inverse = np.where(known, 1.0 / np.where(known, singular, 1.0), 0.0)
    pseudo = (directions.T * inverse**2) @ directions
    freedom = max(1, rows - count)
    classical = pseudo * inner(residual, residual) / freedom
    whitening = (directions[known].T / singular[known]).T / scale
    found = stretch_of(
        jacobian, residual, whitening, even_segments(rows) if segments is None else segments
    )
    stretch = np.sqrt(found.ratio)
    matrix = classical * np.outer(stretch, stretch) / np.outer(scale, scale)
    if found.correlation is not None:
        stderr = np.sqrt(np.diag(matrix))
        matrix = found.correlation * np.outer(stderr, stderr)
    unknown = (norms == 0.0) | (np.abs(directions[~known]).max(axis=0, initial=0.0) > 1e-3)
    if rows <= count:  # no degree of freedom is left to estimate the noise
        unknown[:] = True
    of_all = scale / stretch / max(np.sqrt(inner(residual, residual) / freedom), _EXACT)
    information = (directions.T * np.where(known, singular, 0.0) ** 2) @ directions
    information *= np.outer(of_all, of_all)
    if rows <= count:
        information[:] = 0.0
    elif found.correlation is not None and not unknown.any():
        information = _inverse(matrix)
    matrix[unknown, unknown] = np.inf

    centred = triangle.copy()
    if centre is not None:
        gain, offset, mean = centre
        centred[:, gain] -= mean * triangle[:, offset]
    centred_norms = column_sizes(centred)
    centred /= np.where(centred_norms > 0.0, centred_norms, 1.0)
    _, values, vectors = np.linalg.svd(centred, full_matrices=False)
    # A floor, so that two identical columns are fully correlated.
    inverse = 1.0 / np.maximum(values, 1e-12 * values[0] + 1e-150)
    spread = (vectors.T * inverse**2) @ vectors
    deviation = np.sqrt(np.diag(spread))
    correlation = np.clip(spread / np.outer(deviation, deviation), -1.0, 1.0)
    np.fill_diagonal(correlation, 1.0)
    return Covariance(
        matrix=matrix,
        information=information,
        stderr=np.sqrt(np.diag(matrix)),
        freedom=found.freedom,
        white=found.white,
        correlation=correlation,
        condition=float(values[0] / values[-1]) if values[-1] > 0.0 else float("inf"),
        weakest=vectors[-1],
    )


def _inverse(covariance: Array) -> Array:
    """The inverse of a covariance, whatever the units."""
    scale = np.sqrt(np.diag(covariance))
    values, vectors = np.linalg.eigh(covariance / np.outer(scale, scale))
    # Of segments fewer than parameters the correlations are barely a matrix of correlations.
    inverse: Array = (vectors / np.maximum(values, _SINGULAR)) @ vectors.T / np.outer(scale, scale)
    return inverse
