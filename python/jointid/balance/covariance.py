"""Uncertainty of a least-squares estimate: covariance, correlations and the least determined direction."""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.balance.least_squares import solve
from jointid.balance.segments import Segments, even_segments
from jointid.base.values import dataclass

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True)
class Covariance:
    """Covariance and related numbers of an estimate.

    Attributes
    ----------
    matrix : ndarray, shape (p, p)
        Covariance of the parameters, in the product of their units.
    information : ndarray, shape (p, p)
        Inverse of the covariance; zero along a direction that the data do not determine.
    stderr : ndarray, shape (p,)
        Standard errors.
    freedom : ndarray, shape (p,)
        Degrees of freedom of Student's t, for the intervals.
    white : bool
        Whether the residuals pass all tests of independence.
    correlation : ndarray, shape (p, p)
        Correlations after centring: the offset refers to the mean of the signal that the gain multiplies,
        because the raw correlation depends on the sensor's arbitrary zero.
    condition : float
        Condition number of the centred Jacobian with columns of unit norm.
    weakest : ndarray, shape (p,)
        Unit vector of the least determined direction, in these scaled columns.
    """

    matrix: Array
    information: Array
    stderr: Array
    freedom: Array
    white: bool
    correlation: Array
    condition: float
    weakest: Array

    def without_last(self) -> "Covariance":
        """Return the covariance of all parameters except the last one, which stays unknown."""
        inner, across = self.information[:-1, :-1], self.information[:-1, -1]
        own = float(self.information[-1, -1])
        return replace(
            self,
            matrix=self.matrix[:-1, :-1],
            information=inner - np.outer(across, across) / own if own > 0.0 else inner,
            stderr=self.stderr[:-1],
            freedom=self.freedom[:-1],
            correlation=self.correlation[:-1, :-1],
            weakest=self.weakest[:-1],
        )


class Triangle:
    """R of the QR decomposition of a tall matrix, computed in one pass; sufficient for least squares.

    Parameters
    ----------
    matrix : ndarray, shape (rows, columns)
    threads : int
        Number of threads. 0: all.
    """

    def __init__(self, matrix: Array, threads: int = 0) -> None:
        self.matrix: Array = _core.triangle(matrix, threads=threads)

    def solve(self, columns: list[int], target: int, rcond: float) -> tuple[Array, float]:
        """Return the least-squares coefficients of columns for the target column, and the residual's norm."""
        return solve(self.matrix, columns, target, rcond)


def parameter_covariance(
    jacobian: Array,
    residual: Array,
    centre: tuple[int, int, float] | None,
    triangle: Array | None = None,
    threads: int = 0,
    segments: Segments | None = None,
) -> Covariance:
    """Return the covariance of a least-squares estimate, clustered by motion segments for correlated residuals.

    Parameters
    ----------
    jacobian : ndarray, shape (windows, p)
        Derivatives of the residuals by the free parameters.
    residual : ndarray, shape (windows,)
        Residuals at the minimum.
    centre : (gain, offset, mean) or None
        Columns of a gain and its offset, and the mean of the signal that the gain multiplies.
    triangle : ndarray, shape (rows, p), optional
        Triangle of the Jacobian. Default: computed here.

    segments : Segments, optional
        Segments of motion. Default: sixteen segments with equal numbers of windows.

    Notes
    -----
    The residuals of an imperfect model drift slowly, so that the classical variance is too small. If no test rejects
    white residuals, the variance of each parameter is the larger of the classical variance and White's variance
    (clusters of one window), which allows for noise that depends on the motion. Otherwise it is the mean of two
    clusterings over motion segments. Each segment's scores are corrected for the degrees of freedom that the fit used
    (CR2: Bell and McCaffrey 2002; Pustejovsky and Tipton 2018). The quantile is Student's t with the degrees of freedom
    of each parameter (Satterthwaite). These are few if few segments determine the parameter.
    Directions that the data do not determine have an infinite variance. tests/identification/test_covariance.py tests
    the coverage.
    """
    rows, count = jacobian.shape
    if count == 0:  # all parameters are fixed or ended on a bound
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
    chosen = even_segments(rows) if segments is None else segments
    matrix, information, stderr, own, white, correlation, condition, weakest = _core.covariance(
        jacobian, residual, triangle, [cuts.tolist() for cuts in chosen.cuts], centre
    )
    return Covariance(
        matrix=matrix,
        information=information,
        stderr=stderr,
        freedom=own,
        white=white,
        correlation=correlation,
        condition=condition,
        weakest=weakest,
    )
