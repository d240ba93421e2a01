"""How sure a least-squares answer is: covariance, correlations and the direction the data know least about."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True)
class Covariance:
    """Second-order picture of the penalty at its minimum.

    Attributes
    ----------
    matrix : ndarray, shape (p, p)
        Covariance of the parameters, in the product of their units.
    stderr : ndarray, shape (p,)
        Standard errors.
    correlation : ndarray, shape (p, p)
        Correlations after centring: an offset is taken where the signal that its gain multiplies has
        its mean, because the raw correlation depends on the sensor's arbitrary zero.
    condition : float
        Condition number of the centred Jacobian with columns of unit norm.
    weakest : ndarray, shape (p,)
        Unit vector, in those scaled columns, along which the data say least.
    """

    matrix: Array
    stderr: Array
    correlation: Array
    condition: float
    weakest: Array


# Scores are hardly ever more persistent; beyond, recolouring would amplify its own error.
_MOST_PERSISTENT = 0.97


def _autocovariance_robust(scores: Array) -> Array:
    """Covariance of a sum of autocorrelated scores, prewhitened (Andrews and Monahan 1992).

    Each column is first stripped of its first-order persistence, then Newey and West's (1987) sum is
    taken, then the persistence is put back: a fixed number of lags alone is far too small when
    neighbouring windows miss alike.
    """
    rows = scores.shape[0]
    if rows < 4:
        return np.asarray(scores.T @ scores)
    power = np.einsum("ij,ij->j", scores[:-1], scores[:-1])
    lagged = np.einsum("ij,ij->j", scores[1:], scores[:-1])
    persistence = lagged / np.where(power > 0.0, power, 1.0)
    # The estimate of a persistence is biased down by about (1 + 3 rho) / n (Kendall 1954).
    persistence += (1.0 + 3.0 * persistence) / rows
    persistence = np.clip(persistence, 0.0, _MOST_PERSISTENT)
    white = scores.copy()
    white[1:] -= persistence * scores[:-1]
    white[0] *= np.sqrt(1.0 - persistence**2)
    lags = int(4.0 * (rows / 100.0) ** (2.0 / 9.0))
    total = white.T @ white
    for lag in range(1, min(lags, rows - 1) + 1):
        cross = white[lag:].T @ white[:-lag]
        total += (1.0 - lag / (lags + 1.0)) * (cross + cross.T)
    recolour = 1.0 / (1.0 - persistence)
    return np.asarray(total * np.outer(recolour, recolour))


def parameter_covariance(
    jacobian: Array, residual: Array, centre: tuple[int, int, float] | None
) -> Covariance:
    """Covariance of a least-squares estimate, robust to autocorrelated residuals.

    Parameters
    ----------
    jacobian : ndarray, shape (windows, p)
        Derivatives of the residuals by the free parameters.
    residual : ndarray, shape (windows,)
        Residuals at the minimum.
    centre : (gain, offset, mean) or None
        Columns of a gain and of its offset, and the mean of the signal that the gain multiplies.

    Notes
    -----
    The variance of each parameter is the larger of the classical one and of Newey and West's
    sandwich, prewhitened: residuals of a model that is not perfect drift slowly, and the classical one
    flatters the estimate then. Coverage is tested in
    tests/test_covariance.py. Directions the data leave free get an infinite variance.
    """
    rows, count = jacobian.shape
    if count == 0:  # every parameter is fixed or ended on a bound
        nothing = np.zeros((0, 0))
        return Covariance(
            matrix=nothing,
            stderr=np.zeros(0),
            correlation=nothing,
            condition=1.0,
            weakest=np.zeros(0),
        )
    norms = np.linalg.norm(jacobian, axis=0)
    scale = np.where(norms > 0.0, norms, 1.0)
    _, singular, directions = np.linalg.svd(jacobian / scale, full_matrices=False)
    known = singular > 1e-10 * singular[0]
    inverse = np.where(known, 1.0 / np.where(known, singular, 1.0), 0.0)
    pseudo = (directions.T * inverse**2) @ directions
    freedom = max(1, rows - count)
    classical = pseudo * (residual @ residual) / freedom
    scores = jacobian / scale * residual[:, None]
    robust = pseudo @ _autocovariance_robust(scores) @ pseudo * rows / freedom
    stretch = np.sqrt(np.maximum(np.diag(robust) / np.maximum(np.diag(classical), 1e-300), 1.0))
    matrix = classical * np.outer(stretch, stretch) / np.outer(scale, scale)
    unknown = (norms == 0.0) | (np.abs(directions[~known]).max(axis=0, initial=0.0) > 1e-3)
    if rows <= count:  # nothing is left to tell noise from model
        unknown[:] = True
    matrix[unknown, unknown] = np.inf

    centred = jacobian.copy()
    if centre is not None:
        gain, offset, mean = centre
        centred[:, gain] -= mean * jacobian[:, offset]
    centred_norms = np.linalg.norm(centred, axis=0)
    centred /= np.where(centred_norms > 0.0, centred_norms, 1.0)
    _, values, vectors = np.linalg.svd(centred, full_matrices=False)
    spread = np.linalg.pinv(centred.T @ centred, rcond=1e-20, hermitian=True)
    deviation = np.sqrt(np.maximum(np.diag(spread), 1e-300))
    correlation = np.clip(spread / np.outer(deviation, deviation), -1.0, 1.0)
    np.fill_diagonal(correlation, 1.0)
    return Covariance(
        matrix=matrix,
        stderr=np.sqrt(np.diag(matrix)),
        correlation=correlation,
        condition=float(values[0] / values[-1]) if values[-1] > 0.0 else float("inf"),
        weakest=vectors[-1],
    )


def widened(spread: Covariance, systematic: Array) -> Covariance:
    """The covariance with errors that are not of chance added to each parameter's own; correlations stay.

    Parameters
    ----------
    systematic : ndarray, shape (p,)
        Their sizes, as standard errors.
    """
    known = np.isfinite(spread.stderr) & (spread.stderr > 0.0)
    chance = np.where(known, spread.stderr, 1.0)
    stretch = np.where(known, np.hypot(chance, systematic) / chance, 1.0)
    matrix = spread.matrix * np.outer(stretch, stretch)
    return replace(spread, matrix=matrix, stderr=np.sqrt(np.diag(matrix)))
