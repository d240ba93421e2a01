"""Parameters of a joint: value, bounds, free or fixed; tables of parameters, and merging of tables."""

import functools
from collections.abc import Mapping
from dataclasses import fields
from typing import Any

from jointid import _core
from jointid.base.errors import InputError
from jointid.base.values import dataclass
from jointid.joint.checks import (
    check_flag,
    check_mapping,
    check_parameter_name,
    finite_number,
    is_number,
    positive_number,
    set_numbers,
    suggestion,
)


@dataclass(frozen=True, slots=True, kw_only=True)
class Parameter:
    """One parameter: its known value and bounds before an identification, or its identified value.

    Parameters
    ----------
    name : str
        Name, e.g. "inertia", "coulomb", "static", "stribeck", "viscous", "torque_offset", "gravity_cos",
        "gravity_sin", "sensor_gain", "sensor_offset".
    value : float, optional
        Value in SI units, on the output side of the gear. Default: not known.
    min, max : float, optional
        Bounds of the search, both included. Default: computed from the recording.
    vary : bool
        Whether the parameter is identified; False fixes it at its value. Default True.

    Raises
    ------
    InputError
        The name is unknown, a number is not finite, min exceeds max, or the value is outside the bounds. A fixed
        parameter has no value, or a Stribeck velocity or exponent is not above 0.

    Examples
    --------
    >>> bounded = joint.replace(parameters={"viscous": jid.Parameter(name="viscous", min=0.0, max=40.0)})
    >>> bounded.parameters["viscous"].max
    40.0
    """

    name: str
    value: float | None = None
    min: float | None = None
    max: float | None = None
    vary: bool = True

    def __post_init__(self) -> None:
        check_parameter_name(self.name)
        owner = f"parameter '{self.name}'"
        set_numbers(self, owner, ("value", "min", "max"), finite_number)
        check_flag(owner, "vary", self.vary)
        if self.name.partition("[")[0] in _above_zero():
            for field in ("value", "min", "max"):
                if getattr(self, field) is not None:
                    positive_number(owner, field, getattr(self, field))
        if self.min is not None and self.max is not None and self.min > self.max:
            raise InputError(
                f"it is above max {self.max!r}",
                argument="min",
                value=self.min,
                place=owner,
                remedy="swap them",
            )
        for bound, outside in (("min", "below"), ("max", "above")):
            limit = getattr(self, bound)
            if self.value is None or limit is None:
                continue
            if self.value < limit if bound == "min" else self.value > limit:
                raise InputError(
                    f"it is {outside} {bound} {limit!r}",
                    argument="value",
                    value=self.value,
                    place=owner,
                    remedy=f"give a value inside the bounds, or move {bound}",
                )
        if not self.vary and self.value is None:
            raise InputError(
                "a fixed parameter needs a value",
                argument="vary",
                value=False,
                place=owner,
                remedy="give a value too",
            )


@functools.cache
def _above_zero() -> frozenset[str]:
    """Return the shape parameters that must not be 0."""
    return frozenset(shape for row in _core.terms() if row.above_zero for shape in row.shapes)


def parameter_table(
    entries: Mapping[str, float | Mapping[str, object] | Parameter],
) -> dict[str, Parameter]:
    """Return parameters by name, in the core's order.

    Parameters
    ----------
    entries : mapping
        Entries by parameter name: a number, which fixes it; a mapping with some of ``value``, ``min``,
        ``max``, ``vary``; or a `Parameter`.

    Raises
    ------
    InputError
        A name or field is unknown (the error proposes the nearest known one), or a value is invalid.
    """
    return merge({}, entries)


def merge(
    base: Mapping[str, Parameter],
    changes: Mapping[str, float | Mapping[str, object] | Parameter],
) -> dict[str, Parameter]:
    """Return a parameter table with some fields changed.

    Parameters
    ----------
    base : mapping of str to Parameter
        Table to start from; it is not modified.
    changes : mapping
        Entries as in `parameter_table`. A number changes value and vary. A mapping changes its fields
        (None removes a field). A `Parameter` changes vary and its fields that are not None.

    Raises
    ------
    InputError
        Same errors as in `parameter_table`, or a change contradicts other fields.
    """
    check_mapping("", "parameters", changes)
    table = dict(base)
    for name, entry in changes.items():
        check_parameter_name(name)
        if type(entry) is Parameter and entry.name == name and name not in table:
            table[name] = entry  # frozen, and already checked
            continue
        known = {} if name not in table else _fields(table[name])
        table[name] = Parameter(**{"name": name, **known, **_stated(name, entry)})
    # Harmonics follow the other parameters, in the order of the tables.
    order = _order()
    return {name: table[name] for name in sorted(table, key=lambda n: order.get(n, len(order)))}


@functools.cache
def _order() -> dict[str, int]:
    return {name: place for place, name in enumerate(_core.parameter_names())}


def _fields(parameter: Parameter) -> dict[str, Any]:
    return {
        "name": parameter.name,
        "value": parameter.value,
        "min": parameter.min,
        "max": parameter.max,
        "vary": parameter.vary,
    }


def _stated(name: str, entry: object) -> dict[str, Any]:
    """Return the fields that a table's entry sets."""
    if isinstance(entry, Parameter):
        if entry.name != name:
            raise InputError(
                f"it holds the parameter '{entry.name}'", argument=name, place="parameters"
            )
        return {key: value for key, value in _fields(entry).items() if value is not None}
    if isinstance(entry, Mapping):
        known = [field.name for field in fields(Parameter) if field.name != "name"]
        for key in entry:
            if key not in known:
                raise InputError(
                    f"a parameter has no such field; {suggestion(key, known)}",
                    argument=str(key),
                    place=f"parameter '{name}'",
                )
        return dict(entry)
    if is_number(entry):
        return {"value": finite_number("parameters", name, entry), "vary": False}
    raise InputError(
        "a number (it fixes the parameter) or a table of value, min, max and vary is expected",
        argument=name,
        value=entry,
        place="parameters",
    )
