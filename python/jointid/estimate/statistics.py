"""The parts of an estimate: parameters, residuals, convergence, curves."""

import math
from collections.abc import Mapping
from dataclasses import field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from jointid.base.values import dataclass

Array = NDArray[np.float64]

SYSTEMATIC_PARTS = (
    "windows",
    "sampling",
    "curvature",
    "lag",
    "velocity",
    "extra",
    "symmetry",
    "residual_side",
    "given",
)
"""Systematic errors: they do not decrease with the length of the recording."""

_NOTHING = 1e-12  # N·m, kg·m², ...: a smaller fixed value is a rounding error of 0


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class ParameterEstimate:
    """One parameter of an estimate.

    Attributes
    ----------
    value : float
        Value in `unit`.
    stderr : float or None
        Random standard error, clustered over motion segments if residuals are correlated; None if fixed or on a
        bound.
    interval : tuple of float or None
        95 % interval: random (Student's t, with the degrees of freedom from the segments) plus the systematic parts
        "windows", "sampling", "curvature", "lag", "velocity", "extra" and "symmetry". It holds if the stated facts
        are right. For a coefficient on its bound, it is the random interval without the bound.
    min, max : float
        Bounds of the search.
    vary : bool
        False if it was fixed.
    at_bound : str or None
        "min" or "max" if the search ended on this bound.
    shift_halved, shift_doubled : float or None
        Change of the value with windows of half and double length.
    systematic : mapping of str to float
        Sizes of errors that do not decrease with the recording's length, by name. As one standard error:
        "windows" (change with windows of half and double length, without the effect of noise of velocity and extra
        signals), "curvature" (friction that is not linear between samples), "lag" (certain delays between signals),
        "velocity" (noise of the velocity), "extra" (noise of the extra signals of own terms), "symmetry" (friction that
        differs between directions, for a sensor's offset). At its limit: "sampling" (unknown sampling instant of the
        sensor), "given" (tolerances of the joint's facts). "residual_side": change of the value if the other signal is
        compared (not for a gain by instruments). Parts that do not apply are missing.
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
    systematic: Mapping[str, float] = field(default_factory=dict)

    def __repr__(self) -> str:
        error = "" if self.stderr is None else f" ± {self.stderr:.2g}"
        bound = f", at its {self.at_bound} bound" if self.at_bound else ""
        fixed = "" if self.vary else ", fixed"
        return f"<ParameterEstimate {self.name}: {self.value:.6g}{error} {self.unit}{bound}{fixed}>"

    @property
    def shown_value(self) -> float:
        """The printed value: the bound itself if the search ended there, 0 for a rounding error of 0.

        For example, a search that ends on a bound of 0 gives 1e-17, and cos 90° is 6e-17.
        """
        if self.at_bound is not None:
            return self.min if self.at_bound == "min" else self.max
        return 0.0 if abs(self.value) < _NOTHING and not self.stderr else self.value

    @property
    def systematic_total(self) -> float:
        """Total of the systematic parts: the root of the sum of squares."""
        return math.hypot(*self.systematic.values())

    @property
    def largest_part(self) -> str | None:
        """Name of the largest systematic part; None if all are zero."""
        name = max(self.systematic, key=self.systematic.__getitem__, default=None)
        return name if name is not None and self.systematic[name] > 0.0 else None

    @property
    def uncertainty(self) -> float:
        """Random error and all systematic parts together, as one standard error."""
        return math.hypot(self.stderr or 0.0, self.systematic_total)


def distance_from_bound(p: ParameterEstimate) -> float:
    """Return the possible distance of a value from its bound: inwards, unless the optimum is surely outside."""
    if p.interval is None:
        return math.inf
    inside, beyond = p.interval[1] - p.value, p.value - p.interval[0]
    if p.at_bound == "max":
        inside, beyond = beyond, inside
    return inside if inside >= 0.0 else beyond


@dataclass(frozen=True, slots=True, kw_only=True)
class ResidualStatistics:
    """Statistics of the window residuals.

    Attributes
    ----------
    windows : int
        Number of windows used.
    window_duration : float
        Duration of a window [s].
    noise_share : float
        Variance of the velocity's noise over the variance of its change across a window.
    rms : float
        Root mean square of the residual, as a mean over a window [unit of the compared signal].
    relative : float
        Norm of the residuals over the norm of the measured integrals.
    r_squared : float
        Share of the measured variance that the model explains.
    autocorrelation : float
        Autocorrelation of neighboring windows; 0 for a perfect model with white noise.
    samples : int
        Number of samples in the recordings.
    left_out : float
        Share of sample intervals that are left out: standstill, sticking, gaps.
    standing : float
        Share of samples at which the joint stands still or sticks.
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
        Penalty of the best individual so far, and mean over the population.
    diversity : ndarray
        Measure of genetic diversity, between 0 and 1; an option selects its definition.
    crossover_probability, mutation_probability : ndarray
        Probabilities of the generation; they depend on the diversity if the options request it.
    evaluations : ndarray of int
        Number of penalties computed so far.
    """

    generation: NDArray[np.int64]
    best: Array
    mean: Array
    diversity: Array
    crossover_probability: Array
    mutation_probability: Array
    evaluations: NDArray[np.int64]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False, repr=False)
class FrictionCurve:
    """The estimated friction map; `numpy.asarray` returns `torque`.

    Attributes
    ----------
    velocity : ndarray
        Velocities [rad/s or m/s].
    torque : ndarray
        Friction [N·m or N]; 0 at rest, where friction has any value up to the breakaway friction.
    lower, upper : ndarray
        Pointwise 95 % band.
    """

    velocity: Array
    torque: Array
    lower: Array
    upper: Array

    def __repr__(self) -> str:
        return f"<FrictionCurve: {np.size(self.torque)} velocities, with a 95 % band>"

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> Array:
        """Return the torque."""
        return np.array(self.torque, dtype=dtype)
