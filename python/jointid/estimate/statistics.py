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
"""What moves a value however long the recording is."""

_NOTHING = 1e-12  # N·m, kg·m², ...: below it a fixed value is what rounding left of 0


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class ParameterEstimate:
    """One parameter of an estimate.

    Attributes
    ----------
    value : float
        In `unit`.
    stderr : float or None
        Standard error: of chance alone, clustered over motion segments where the residuals hang together; None when
        fixed or held at a bound.
    interval : tuple of float or None
        95 % interval: of chance (Student's t, with as many degrees of freedom as the segments give), and of the
        systematic parts "windows", "sampling", "curvature", "lag", "velocity", "extra" and "symmetry". It holds if the
        given facts are right. Of a coefficient on its bound it is the interval as if there were no bound, of chance
        alone.
    min, max : float
        Bounds of the search.
    vary : bool
        False when it was fixed.
    at_bound : str or None
        "min" or "max" when the search ended on a bound.
    shift_halved, shift_doubled : float or None
        How the value moves when the windows are halved and doubled.
    systematic : mapping of str to float
        Sizes of errors that do not decrease with the recording's length, by name:
        "windows" (how the value moves when they are halved and doubled, without what noise of the velocity and of
        extra signals adds to that), "curvature" (friction that is not straight between samples), "lag" (delays
        between signals that are certain), "velocity" (its noise), "extra" (noise of the extra signals of own terms),
        "symmetry" (of a sensor's offset: friction that is not the same in both directions), all as one standard
        error; "sampling" (the unknown instant of the sensor's sample), at its limit; "residual_side" (how the value
        moves when the other signal is compared; a gain by instruments needs no side); "given" (the tolerances of the
        joint's facts, at their limits). Parts that do not apply are missing.
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
        """The value as it is printed: the bound itself where the search ended there, 0 for what rounding left.

        A search that ends on a bound of 0 leaves 1e-17, and cos 90° is 6e-17.
        """
        if self.at_bound is not None:
            return self.min if self.at_bound == "min" else self.max
        return 0.0 if abs(self.value) < _NOTHING and not self.stderr else self.value

    @property
    def systematic_total(self) -> float:
        """The systematic parts together: the root of the sum of their squares."""
        return math.hypot(*self.systematic.values())

    @property
    def largest_part(self) -> str | None:
        """Name of the largest systematic part; None when all are zero."""
        name = max(self.systematic, key=self.systematic.__getitem__, default=None)
        return name if name is not None and self.systematic[name] > 0.0 else None

    @property
    def uncertainty(self) -> float:
        """Chance and all systematic parts together, as one standard error."""
        return math.hypot(self.stderr or 0.0, self.systematic_total)


def distance_from_bound(p: ParameterEstimate) -> float:
    """Return how far a value may be off its bound: within it, unless the best value lies beyond it for certain."""
    if p.interval is None:
        return math.inf
    inside, beyond = p.interval[1] - p.value, p.value - p.interval[0]
    if p.at_bound == "max":
        inside, beyond = beyond, inside
    return inside if inside >= 0.0 else beyond


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
        Autocorrelation of neighboring windows; 0 for a perfect model with white noise.
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


@dataclass(frozen=True, slots=True, kw_only=True, eq=False, repr=False)
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

    def __repr__(self) -> str:
        return f"<FrictionCurve: {np.size(self.torque)} velocities, with a 95 % band>"

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> Array:
        """The torque."""
        return np.array(self.torque, dtype=dtype)
