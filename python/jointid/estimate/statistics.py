"""The parts of an estimate: parameters, residuals, convergence, curves."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True)
class ParameterEstimate:
    """One parameter of an estimate.

    Attributes
    ----------
    value : float
        In `unit`.
    stderr : float or None
        Standard error, robust to autocorrelated residuals, with how the value moves with the windows and
        with the instant at which a sensor is sampled; None when fixed or held at a bound.
    interval : tuple of float or None
        95 % confidence interval (Student's t).
    min, max : float
        Bounds of the search.
    vary : bool
        False when it was fixed.
    at_bound : str or None
        "min" or "max" when the search ended on a bound.
    shift_halved, shift_doubled : float or None
        How the value moves when the windows are halved and doubled.
    """

    name: str
    meaning: str
    unit: str
    value: float
    stderr: float | None
    interval: tuple[float, float] | None
    min: float
    max: float
    vary: bool
    at_bound: str | None
    shift_halved: float | None
    shift_doubled: float | None


@dataclass(frozen=True, slots=True, kw_only=True)
class ResidualStatistics:
    """The window residuals in numbers.

    Attributes
    ----------
    windows : int
        Windows used.
    window_duration : float
        [s]
    noise_share : float
        Variance of the velocity's noise over that of its change across a window.
    rms : float
        Root mean square of the residual, as a mean over a window [unit of the compared signal].
    relative : float
        Norm of the residuals over the norm of the measured integrals.
    r_squared : float
        Share of the measured variance that the model explains.
    autocorrelation : float
        Of neighbouring windows; 0 for a perfect model with white noise.
    samples : int
        Samples in the recordings.
    left_out : float
        Share of the sample intervals left out: standing still, sticking, gaps.
    standing : float
        Share of the samples at which the joint stood still or stuck.
    """

    windows: int
    window_duration: float
    noise_share: float
    rms: float
    relative: float
    r_squared: float
    autocorrelation: float
    samples: int
    left_out: float
    standing: float


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Convergence:
    """The search, generation by generation.

    Attributes
    ----------
    generation : ndarray of int
    best, mean : ndarray
        Penalty of the best individual so far and mean over the population.
    diversity : ndarray
        Genetic diversity measure, between 0 and 1; how it is formed is an option.
    crossover_probability, mutation_probability : ndarray
        As used for the generation; they follow the diversity when the options say so.
    evaluations : ndarray of int
        Penalties computed so far.
    """

    generation: NDArray[np.int64]
    best: Array
    mean: Array
    diversity: Array
    crossover_probability: Array
    mutation_probability: Array
    evaluations: NDArray[np.int64]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class FrictionCurve:
    """The estimated friction map; `numpy.asarray` of it is `torque`.

    Attributes
    ----------
    velocity : ndarray
        [rad/s or m/s]
    torque : ndarray
        [N·m or N]; 0 at rest, where friction takes any value up to the breakaway friction.
    lower, upper : ndarray
        Pointwise 95 % band.
    """

    velocity: Array
    torque: Array
    lower: Array
    upper: Array

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> Array:
        """The torque."""
        return np.array(self.torque, dtype=dtype)
