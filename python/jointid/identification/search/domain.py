"""The search domain: bounds from joint and call, otherwise from the data."""

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.base.advice import Action
from jointid.base.errors import InputError
from jointid.base.values import dataclass
from jointid.identification.search.computed_bounds import ComputedBounds, shape_bounds, shape_range
from jointid.identification.search.gain_domain import around
from jointid.identification.search.stated_bounds import known_parameters
from jointid.joint.joint import Joint
from jointid.joint.parameters import Parameter

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True)
class SearchDomain:
    """Bounds of every parameter, in the penalty's order; equal bounds fix it.

    Attributes
    ----------
    names : tuple of str
    lower, upper : ndarray, shape (p,)
    from_data : tuple of str
        Parameters with at least one bound that was computed from the data.
    guessed_sign : bool
        Whether the search covers only one sign of the sensor gain although the other sign fits equally well.
    """

    names: tuple[str, ...]
    lower: NDArray[np.float64]
    upper: NDArray[np.float64]
    from_data: tuple[str, ...]
    guessed_sign: bool = False

    def fixed(self, name: str) -> bool:
        """Return whether the parameter is fixed."""
        index = self.names.index(name)
        return bool(self.lower[index] == self.upper[index])


def domain_for(
    penalty: _core.Penalty,
    joint: Joint | None,
    changes: Mapping[str, float | Mapping[str, object] | Parameter] | None,
    peak_speed: float,
    known: Sequence[Parameter] | None = None,
) -> SearchDomain:
    """Return bounds for every parameter of the penalty.

    Parameters
    ----------
    penalty : Penalty
    joint : Joint or None
        Joint. Its known values fix parameters, and its parameter table gives bounds.
    changes : mapping or None
        Argument `parameters` of the call. A number fixes a parameter.
    peak_speed : float
        Largest speed in the recordings [rad/s or m/s].
    known : sequence of Parameter, optional
        Value and bounds of each parameter, set by joint and call. Default: computed here.

    Raises
    ------
    InputError
        A parameter that is not in the model, or invalid bounds.
    """
    names = tuple(penalty.names)
    lower = np.empty(len(names))
    upper = np.empty(len(names))
    from_data = []
    if known is None:
        known = known_parameters(names, joint, changes)
    fixed = {
        name: each.value
        for name, each in zip(names, known, strict=True)
        if not each.vary and each.value is not None
    }
    shapes = [shape_range(each, peak_speed) for each in known[penalty.coefficients :]]
    computed = ComputedBounds(penalty, shapes, _signs(known))
    for index, (name, parameter) in enumerate(zip(names, known, strict=True)):
        if not parameter.vary:
            assert parameter.value is not None  # a fixed Parameter always has a value
            lower[index] = upper[index] = parameter.value
            continue
        low, high = parameter.min, parameter.max
        if low is None or high is None:
            from_data.append(name)
            if index >= penalty.coefficients:
                bounds = shape_bounds(name, peak_speed)
            elif name == "sensor_gain" and parameter.value:
                bounds = around(parameter.value)
            else:
                bounds = computed.of_coefficient(index, fixed)
            low = bounds[0] if low is None else low
            high = bounds[1] if high is None else high
        if not low < high:
            raise InputError(
                f"its min {low:g} is not below its max {high:g}",
                argument=name,
                place="parameters",
                remedy="widen the bounds, or fix the parameter with a number",
            )
        lower[index], upper[index] = low, high
    _refuse_zero_gain(penalty, names, lower, upper)
    if lower.tolist() == upper.tolist():
        raise InputError("every parameter is fixed; leave at least one free", argument="parameters")
    return SearchDomain(
        names=names,
        lower=lower,
        upper=upper,
        from_data=tuple(from_data),
        guessed_sign=computed.guessed_sign,
    )


def _signs(known: Sequence[Parameter]) -> tuple[float, ...]:
    """Return the signs of the sensor gain that its bounds allow."""
    for each in known:
        if each.name == "sensor_gain":
            if each.min is not None and each.min >= 0.0:
                return (1.0,)
            if each.max is not None and each.max <= 0.0:
                return (-1.0,)
    return (1.0, -1.0)


def _refuse_zero_gain(
    penalty: _core.Penalty, names: tuple[str, ...], lower: Array, upper: Array
) -> None:
    if "sensor_gain" not in names or penalty.residual == _core.Residual.torque:
        return
    index = names.index("sensor_gain")
    if lower[index] <= 0.0 <= upper[index]:
        raise InputError(
            f"its bounds, {lower[index]:g} to {upper[index]:g}, contain 0, but the sensor residual is not defined for "
            "a gain of 0",
            argument="sensor_gain",
            place="parameters",
            remedy=(
                "set its min above 0",
                "set its max below 0",
                Action("call", {"residual": "torque"}),
            ),
        )
