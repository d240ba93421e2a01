"""Search bounds computed from the recordings, for parameters without bounds."""

from collections.abc import Iterator, Mapping

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.base.advice import Action
from jointid.base.errors import InputError
from jointid.identification.search.gain_domain import GainGuess, guess_gain
from jointid.joint.parameters import Parameter
from jointid.problem.inner_products import size

# Bound of a coefficient, as a multiple of the value at which its term alone explains the torque.
_GENEROUS = 10.0
# The Stribeck velocity lies between these shares of the peak speed. Outside them, hardly any data determine it. A
# lower share of 0.02 excludes one in twenty simulated joints with clean fast motion and makes their static friction up
# to 32 % wrong.
_SLOWEST_STRIBECK = 0.01
_FASTEST_STRIBECK = 0.5
# Shapes at which a gain is searched, as logarithmic positions between their bounds; fewer for long recordings.
_SHARES = (0.25, 0.5, 0.75, 1.0)
_LONG = 500_000

Array = NDArray[np.float64]


def shape_bounds(name: str, peak_speed: float) -> tuple[float, float]:
    """Return the bounds of a shape parameter for a recording's peak speed [rad/s or m/s].

    The name must be in the core's table.
    """
    shape = _core.shape(name)
    if shape.speed_power == 0.0:
        return shape.lower, shape.upper
    low, high = (
        (share * peak_speed) ** shape.speed_power
        for share in (_SLOWEST_STRIBECK, _FASTEST_STRIBECK)
    )
    return (low, high) if shape.speed_power > 0.0 else (high, low)


def shape_range(parameter: Parameter, peak_speed: float) -> tuple[float, float]:
    """Return the range of a shape parameter: as the caller sets it, otherwise from the data."""
    if not parameter.vary and parameter.value is not None:
        return parameter.value, parameter.value
    low, high = shape_bounds(parameter.name, peak_speed)
    return (
        low if parameter.min is None else parameter.min,
        high if parameter.max is None else parameter.max,
    )


class ComputedBounds:
    """Bounds of coefficients from the size of the penalty's columns. Each column is computed once.

    Parameters
    ----------
    penalty : Penalty
    shapes : list of tuple of float
        Range of each shape parameter.
    signs : tuple of float
        Possible signs of the sensor's gain.
    """

    def __init__(
        self,
        penalty: _core.Penalty,
        shapes: list[tuple[float, float]],
        signs: tuple[float, ...],
    ) -> None:
        self.penalty, self._shapes = penalty, shapes
        self._columns: Array | None = None
        self._signs = signs
        self._gain: GainGuess | None = None

    @property
    def guessed_sign(self) -> bool:
        """Whether a gain was estimated and its sign is not clear."""
        return self._gain is not None and not self._gain.clear

    def of_coefficient(self, index: int, fixed: Mapping[str, float]) -> tuple[float, float]:
        """Return lower and upper bound of a coefficient.

        Parameters
        ----------
        index : int
            Index of the coefficient in the penalty.
        fixed : mapping of str to float
            Values of the fixed parameters.

        Raises
        ------
        InputError
            The recordings contain no information about the coefficient.
        """
        penalty = self.penalty
        term, name = penalty.terms[index], penalty.names[index]
        extent = size(self._lowest[:, index])
        if extent == 0.0:
            raise InputError(
                "this parameter has no effect in the recorded motion",
                argument=name,
                place="parameters",
                remedy=Action("call", {"parameters": {name: ...}}, text="which fixes it"),
            )
        level = size(penalty.target)
        if level == 0.0:
            raise InputError(
                "all samples of this signal are zero, so nothing can be identified",
                argument="torque",
                place="recording",
            )
        if term.name == "sensor_gain":
            return self._gain_for(fixed).bounds
        scale = level / extent
        if term.name == "sensor_offset":
            return self._offset_bounds(scale, fixed)
        return (0.0 if term.non_negative else -_GENEROUS * scale), _GENEROUS * scale

    @property
    def _lowest(self) -> Array:
        """Columns at the lower bounds of the shapes."""
        if self._columns is None:
            self._columns = self.penalty.columns(np.array([low for low, _ in self._shapes]))
        return self._columns

    def _gain_for(self, fixed: Mapping[str, float]) -> GainGuess:
        """Return the sensor gain by least squares at several shapes between the bounds."""
        if self._gain is None:
            self._gain = guess_gain(self.penalty, self._shaped(), fixed, self._signs)
        return self._gain

    def _shaped(self) -> Iterator[Array]:
        yield self._lowest
        shares = _SHARES if self.penalty.total_samples < _LONG else _SHARES[1:2]
        for share in shares if self._shapes else ():
            ends = [(max(low, 1e-300), high) for low, high in self._shapes]
            yield self.penalty.columns(
                np.array([low * (high / low) ** share for low, high in ends])
            )

    def _offset_bounds(self, scale: float, fixed: Mapping[str, float]) -> tuple[float, float]:
        """Return bounds that contain the torque's level and the mean reading times any likely gain."""
        penalty = self.penalty
        reading = self._lowest[:, penalty.names.index("sensor_gain")]
        mean = float(reading.sum() / penalty.usable_duration.sum())
        gain = fixed.get("sensor_gain")
        if gain is None:
            guess = self._gain_for(fixed)
            gain = _GENEROUS * max(guess.swing, abs(guess.value))
        reach = _GENEROUS * scale + abs(mean) * abs(gain)
        return -reach, reach
