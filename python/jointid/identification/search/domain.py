"""Where the search looks: bounds from the joint file and the call, the rest from the data."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.base.argument_checks import require_mapping
from jointid.base.errors import InputError
from jointid.identification.search.gain_domain import GainGuess, around, guess_gain
from jointid.joint.joint import Joint
from jointid.joint.parameters import Parameter, merge
from jointid.problem.inner_products import size

# A coefficient's bound is this many times the value at which its term alone would make up the torque.
_GENEROUS = 10.0
# The Stribeck velocity lies between these shares of the peak speed: outside, nobody could see it.
_SLOWEST_STRIBECK = 0.02
_FASTEST_STRIBECK = 0.5
# Shapes at which a gain is looked for, in logarithms between their bounds; fewer on long recordings.
_SHARES = (0.25, 0.5, 0.75, 1.0)
_LONG = 500_000

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True)
class SearchDomain:
    """Bounds of every parameter, in the penalty's order; equal bounds fix it.

    Attributes
    ----------
    names : tuple of str
    lower, upper : ndarray, shape (p,)
    from_data : tuple of str
        Parameters at least one of whose bounds had to be taken from the data.
    guessed_sign : bool
        Whether the sensor's gain is looked for on one side of zero though the other fits as well.
    """

    names: tuple[str, ...]
    lower: NDArray[np.float64]
    upper: NDArray[np.float64]
    from_data: tuple[str, ...]
    guessed_sign: bool = False

    def fixed(self, name: str) -> bool:
        """Whether the parameter is fixed."""
        index = self.names.index(name)
        return bool(self.lower[index] == self.upper[index])


def _shape_range(parameter: Parameter, peak_speed: float) -> tuple[float, float]:
    """Where a shape lies, as far as it is known."""
    if not parameter.vary and parameter.value is not None:
        return parameter.value, parameter.value
    low, high = _shape_bounds(parameter.name, peak_speed)
    return (
        low if parameter.min is None else parameter.min,
        high if parameter.max is None else parameter.max,
    )


def _shape_bounds(name: str, peak_speed: float) -> tuple[float, float]:
    """Default bounds of a shape; a name that the core's table does not have is a bug."""
    shape = _core.shape(name)
    if shape.speed_power == 0.0:
        return shape.lower, shape.upper
    low, high = (
        (share * peak_speed) ** shape.speed_power
        for share in (_SLOWEST_STRIBECK, _FASTEST_STRIBECK)
    )
    return (low, high) if shape.speed_power > 0.0 else (high, low)


class _Recorded:
    """The penalty's terms on the recording, each computed once."""

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
        """Whether a gain was looked for, and its sign is not clear."""
        return self._gain is not None and not self._gain.clear

    @property
    def columns(self) -> Array:
        """At the shapes' lower bounds."""
        if self._columns is None:
            self._columns = self.penalty.columns(np.array([low for low, _ in self._shapes]))
        return self._columns

    def gain(self, fixed: Mapping[str, float]) -> GainGuess:
        """Of the sensor, by least squares over shapes between the bounds."""
        if self._gain is None:
            self._gain = guess_gain(self.penalty, self._shaped(), fixed, self._signs)
        return self._gain

    def _shaped(self) -> Iterator[Array]:
        yield self.columns
        shares = _SHARES if self.penalty.total_samples < _LONG else _SHARES[1:2]
        for share in shares if self._shapes else ():
            ends = [(max(low, 1e-300), high) for low, high in self._shapes]
            yield self.penalty.columns(
                np.array([low * (high / low) ** share for low, high in ends])
            )

    def coefficient_bounds(self, index: int, fixed: Mapping[str, float]) -> tuple[float, float]:
        """Room for a coefficient that is not bounded."""
        penalty = self.penalty
        term, name = penalty.terms[index], penalty.names[index]
        extent = size(self.columns[:, index])
        if extent == 0.0:
            raise InputError(
                f"the recording does not excite '{name}' at all: fix it with parameters={{'{name}': value}}"
            )
        level = size(penalty.target)
        if level == 0.0:
            raise InputError("the torque is zero throughout: there is nothing to identify")
        if term.name == "sensor_gain":
            return self.gain(fixed).bounds
        scale = level / extent
        if term.name == "sensor_offset":
            return self._offset_bounds(scale, fixed)
        return (0.0 if term.non_negative else -_GENEROUS * scale), _GENEROUS * scale

    def _offset_bounds(self, scale: float, fixed: Mapping[str, float]) -> tuple[float, float]:
        """Room for the torque's level and for the reading's mean times any likely gain."""
        penalty = self.penalty
        reading = self.columns[:, penalty.names.index("sensor_gain")]
        mean = float(reading.sum() / penalty.usable_duration.sum())
        gain = fixed.get("sensor_gain")
        if gain is None:
            guess = self.gain(fixed)
            gain = _GENEROUS * max(guess.swing, abs(guess.value))
        reach = _GENEROUS * scale + abs(mean) * abs(gain)
        return -reach, reach


def _known_values(joint: Joint | None) -> dict[str, Parameter]:
    """What the joint's own facts fix: reflected inertia, and gravity when it is known."""
    values: dict[str, Parameter] = {}
    if joint is None:
        return values
    if joint.reflected_inertia is not None:
        values["inertia"] = Parameter(name="inertia", value=joint.reflected_inertia, vary=False)
    if joint.model.resolved.gravity == "known":
        gravity = joint.gravity_coefficients
        values["gravity_cos"] = Parameter(name="gravity_cos", value=gravity.cos, vary=False)
        values["gravity_sin"] = Parameter(name="gravity_sin", value=gravity.sin, vary=False)
    return values


def domain_for(
    penalty: _core.Penalty,
    joint: Joint | None,
    changes: Mapping[str, float | Mapping[str, object] | Parameter] | None,
    peak_speed: float,
) -> SearchDomain:
    """Bounds for every parameter of the penalty.

    Parameters
    ----------
    penalty : Penalty
    joint : Joint or None
        Its known values fix parameters, its parameter table gives bounds.
    changes : mapping or None
        The call's `parameters=`; a number fixes.
    peak_speed : float
        Largest speed in the recordings [rad/s or m/s].

    Raises
    ------
    InputError
        A parameter that the model does not have, or bounds that cannot be.
    """
    names = tuple(penalty.names)
    table = parameter_bounds(names, joint, changes)
    lower = np.empty(len(names))
    upper = np.empty(len(names))
    from_data = []
    known = [
        table.get(name) or table.get(name.split("[")[0]) or Parameter(name=name) for name in names
    ]
    fixed = {
        name: each.value
        for name, each in zip(names, known, strict=True)
        if not each.vary and each.value is not None
    }
    shapes = [_shape_range(each, peak_speed) for each in known[penalty.coefficients :]]
    recorded = _Recorded(penalty, shapes, _signs(known))
    for index, (name, parameter) in enumerate(zip(names, known, strict=True)):
        if not parameter.vary:
            assert parameter.value is not None  # Parameter refuses a fixed one without
            lower[index] = upper[index] = parameter.value
            continue
        low, high = parameter.min, parameter.max
        if low is None or high is None:
            from_data.append(name)
            if index >= penalty.coefficients:
                bounds = _shape_bounds(name, peak_speed)
            elif name == "sensor_gain" and parameter.value:
                bounds = around(parameter.value)
            else:
                bounds = recorded.coefficient_bounds(index, fixed)
            low = bounds[0] if low is None else low
            high = bounds[1] if high is None else high
        if not low < high:
            raise InputError(
                f"parameters: '{name}' has no room between min {low:g} and max {high:g}; "
                "fix it with a number, or widen the bounds"
            )
        lower[index], upper[index] = low, high
    _refuse_zero_gain(penalty, names, lower, upper)
    _refuse_collinear(names, lower, upper)
    if bool(np.all(lower == upper)):
        raise InputError("parameters: every parameter is fixed; leave at least one to identify")
    return SearchDomain(
        names=names,
        lower=lower,
        upper=upper,
        from_data=tuple(from_data),
        guessed_sign=recorded.guessed_sign,
    )


def _signs(known: list[Parameter]) -> tuple[float, ...]:
    """Signs of the sensor's gain that one bound leaves."""
    for each in known:
        if each.name == "sensor_gain":
            if each.min is not None and each.min >= 0.0:
                return (1.0,)
            if each.max is not None and each.max <= 0.0:
                return (-1.0,)
    return (1.0, -1.0)


def parameter_bounds(
    names: tuple[str, ...],
    joint: Joint | None,
    changes: Mapping[str, float | Mapping[str, object] | Parameter] | None,
) -> dict[str, Parameter]:
    """What joint and call say of the parameters `names`, and of others that the joint knows.

    Raises
    ------
    InputError
        The call names a parameter that is not among them, or bounds that cannot be.
    """
    if changes is not None:
        require_mapping("parameters", changes, "{'coulomb': {'max': 50.0}}")
    table = merge(_known_values(joint), joint.parameters if joint is not None else {})
    table = merge(
        table, {name: _freed(table, name, entry) for name, entry in (changes or {}).items()}
    )
    for name in changes or {}:
        if name not in names and not any(other.startswith(f"{name}[") for other in names):
            raise InputError(
                f"parameters: '{name}' is not part of this identification; its parameters are {', '.join(names)}"
            )
    return table


def _freed(
    table: Mapping[str, Parameter], name: str, entry: float | Mapping[str, object] | Parameter
) -> float | Mapping[str, object] | Parameter:
    """Bounds for what the joint knows as a fact mean that it is to be found."""
    fixed = name in table and not table[name].vary
    if (
        fixed
        and isinstance(entry, Mapping)
        and {"min", "max"} & entry.keys()
        and "vary" not in entry
    ):
        return {"value": None, **entry, "vary": True}
    return entry


def _refuse_zero_gain(
    penalty: _core.Penalty, names: tuple[str, ...], lower: Array, upper: Array
) -> None:
    if "sensor_gain" not in names or penalty.residual != _core.Residual.sensor:
        return
    index = names.index("sensor_gain")
    if lower[index] <= 0.0 <= upper[index]:
        raise InputError(
            "parameters: 'sensor_gain' must keep clear of 0 with residual 'sensor', its bounds are "
            f"{lower[index]:g} to {upper[index]:g}; give it a min above 0 (or a max below), or use residual='torque'"
        )


def _refuse_collinear(names: tuple[str, ...], lower: Array, upper: Array) -> None:
    free = {name for name, low, high in zip(names, lower, upper, strict=True) if low < high}
    if {"coulomb_positive", "coulomb_negative", "sensor_offset"} <= free:
        raise InputError(
            "asymmetric Coulomb friction and sensor_offset are the same where the joint moves; fix the offset with "
            "parameters={'sensor_offset': value}, or use asymmetric=False"
        )
