"""Where the search looks: bounds from the joint file and the call, the rest from the data."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.errors import InputError
from jointid.joint.joint import Joint
from jointid.joint.parameters import Parameter, merge

# A coefficient's bound is this many times the value at which its term alone would make up the torque.
_GENEROUS = 10.0
# The Stribeck velocity lies between these shares of the peak speed: outside, nobody could see it.
_SLOWEST_STRIBECK = 0.02
_FASTEST_STRIBECK = 0.5


@dataclass(frozen=True, slots=True, kw_only=True)
class SearchDomain:
    """Bounds of every parameter, in the penalty's order; equal bounds fix it.

    Attributes
    ----------
    names : tuple of str
    lower, upper : ndarray, shape (p,)
    from_data : tuple of str
        Parameters at least one of whose bounds had to be taken from the data.
    """

    names: tuple[str, ...]
    lower: NDArray[np.float64]
    upper: NDArray[np.float64]
    from_data: tuple[str, ...]

    def fixed(self, name: str) -> bool:
        """Whether the parameter is fixed."""
        index = self.names.index(name)
        return bool(self.lower[index] == self.upper[index])


def _shape_bounds(peak_speed: float) -> tuple[float, float]:
    return (_FASTEST_STRIBECK * peak_speed) ** -2, (_SLOWEST_STRIBECK * peak_speed) ** -2


def _coefficient_bounds(
    penalty: _core.Penalty, index: int, peak_speed: float
) -> tuple[float, float]:
    term = {entry.name: entry for entry in _core.terms()}[penalty.names[index]]
    shapes = np.full(len(penalty.names) - penalty.coefficients, _shape_bounds(peak_speed)[0])
    column = penalty.columns(shapes)[:, index]
    size = float(np.linalg.norm(column))
    if size == 0.0:
        raise InputError(
            f"the recording does not excite '{term.name}' at all: fix it with parameters={{'{term.name}': value}}"
        )
    scale = float(np.linalg.norm(penalty.target)) / size
    if term.name == "sensor_gain":
        spread = float(np.std(column)) or size / np.sqrt(len(column))
        reach = float(np.std(penalty.target)) / spread
        sign = 1.0 if float(column @ penalty.target) >= 0.0 else -1.0
        bounds = sorted((sign * reach / 100.0, sign * reach * _GENEROUS))
        return bounds[0], bounds[1]
    if scale == 0.0:
        raise InputError("the torque is zero throughout: there is nothing to identify")
    return (0.0 if term.non_negative else -_GENEROUS * scale), _GENEROUS * scale


def _known_values(joint: Joint | None) -> dict[str, Parameter]:
    """What the joint's own facts fix: reflected inertia, and gravity when it is known."""
    values: dict[str, Parameter] = {}
    if joint is None:
        return values
    if joint.reflected_inertia is not None:
        values["inertia"] = Parameter(name="inertia", value=joint.reflected_inertia, vary=False)
    if joint.gravity == "known":
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
    table = merge(_known_values(joint), joint.parameters if joint is not None else {})
    table = merge(table, changes or {})
    names = tuple(penalty.names)
    for name in changes or {}:
        if name not in names:
            raise InputError(
                f"parameters: '{name}' is not part of this identification; its parameters are {', '.join(names)}"
            )
    lower = np.empty(len(names))
    upper = np.empty(len(names))
    from_data = []
    for index, name in enumerate(names):
        parameter = table.get(name, Parameter(name=name))
        if not parameter.vary:
            assert parameter.value is not None  # Parameter refuses a fixed one without
            lower[index] = upper[index] = parameter.value
            continue
        low, high = parameter.min, parameter.max
        if low is None or high is None:
            from_data.append(name)
            if index >= penalty.coefficients:
                bounds = _shape_bounds(peak_speed)
            else:
                bounds = _coefficient_bounds(penalty, index, peak_speed)
            low = bounds[0] if low is None else low
            high = bounds[1] if high is None else high
        if not low < high:
            raise InputError(
                f"parameters: '{name}' has no room between min {low:g} and max {high:g}; "
                "fix it with a number, or widen the bounds"
            )
        lower[index], upper[index] = low, high
    if bool(np.all(lower == upper)):
        raise InputError("parameters: every parameter is fixed; leave at least one to identify")
    return SearchDomain(names=names, lower=lower, upper=upper, from_data=tuple(from_data))
