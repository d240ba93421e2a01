"""Parameters of a joint: value, bounds, free or fixed; tables of them, and how tables are merged."""

import math
import numbers
from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, fields
from typing import Any

from jointid import _core
from jointid.base.errors import InputError
from jointid.recording.signals import closest


class FieldError(InputError):
    """A field that cannot be used: whose, which, and what would be right.

    A reader of files puts the place in the file where the owner stands.
    """

    def __init__(self, owner: str, field: str, sentence: str) -> None:
        super().__init__(sentence, argument=field, place=owner)
        self.owner = owner
        self.field = field
        self.sentence = sentence

    def __str__(self) -> str:
        return f"{self.owner}: {self.field} {self.sentence}"

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (self.owner, self.field, self.sentence)


@dataclass(frozen=True, slots=True, kw_only=True)
class Parameter:
    """One parameter: what is known of it before an identification, or was found by one.

    Parameters
    ----------
    name : str
        One of `inertia`, `coulomb`, `static`, `stribeck`, `viscous`, `torque_offset`,
        `gravity_cos`, `gravity_sin`, `sensor_gain`, `sensor_offset`.
    value : float, optional
        In SI units, on the output side of the gear. Default: not known.
    min, max : float, optional
        Bounds of the search, both included. Default: taken from the recording.
    vary : bool
        False fixes the parameter at its value. Default True.

    Raises
    ------
    InputError
        An unknown name, a number that is not finite, min above max, a value outside the bounds,
        or a fixed parameter without a value.
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
        if self.min is not None and self.max is not None and self.min > self.max:
            raise FieldError(owner, "min", f"is {self.min!r}, above max {self.max!r}; swap them")
        for bound, outside in (("min", "below"), ("max", "above")):
            limit = getattr(self, bound)
            if self.value is None or limit is None:
                continue
            if self.value < limit if bound == "min" else self.value > limit:
                raise FieldError(
                    owner,
                    "value",
                    f"is {self.value!r}, {outside} {bound} {limit!r}; "
                    f"give a value inside the bounds, or move {bound}",
                )
        if not self.vary and self.value is None:
            raise FieldError(
                owner, "vary", "is False, but there is no value to fix it at; give a value too"
            )


def parameter_table(
    entries: Mapping[str, float | Mapping[str, object] | Parameter],
) -> dict[str, Parameter]:
    """Return parameters by name, in the core's order.

    Parameters
    ----------
    entries : mapping
        By parameter name: a number, which fixes it; a mapping with some of ``value``, ``min``,
        ``max``, ``vary``; or a `Parameter`.

    Raises
    ------
    InputError
        An unknown name or field (with the nearest known one), or values that cannot be.
    """
    return merge({}, entries)


def merge(
    base: Mapping[str, Parameter],
    changes: Mapping[str, float | Mapping[str, object] | Parameter],
) -> dict[str, Parameter]:
    """Return a parameter table with changes laid over it, field by field.

    Parameters
    ----------
    base : mapping of str to Parameter
        Stays as it is.
    changes : mapping
        As in `parameter_table`. A number changes value and vary; a mapping changes the fields it
        names (None takes one away); a `Parameter` changes vary and all that is not None in it.

    Raises
    ------
    InputError
        As in `parameter_table`; also when a change does not fit what it is laid over.
    """
    if not isinstance(changes, Mapping):
        raise InputError(f"parameters is {changes!r}; a mapping from names is expected")
    table = dict(base)
    for name, entry in changes.items():
        check_parameter_name(name)
        known = {} if name not in table else _fields(table[name])
        table[name] = Parameter(**{"name": name, **known, **_stated(name, entry)})
    # Harmonics stand behind the others, as they came.
    order = {name: place for place, name in enumerate(_core.parameter_names())}
    return {name: table[name] for name in sorted(table, key=lambda n: order.get(n, len(order)))}


def _fields(parameter: Parameter) -> dict[str, Any]:
    return {field.name: getattr(parameter, field.name) for field in fields(parameter)}


def _stated(name: str, entry: object) -> dict[str, Any]:
    """Return the fields that an entry of a table states."""
    if isinstance(entry, Parameter):
        if entry.name != name:
            raise FieldError("parameters", f"'{name}'", f"holds the parameter '{entry.name}'")
        return {key: value for key, value in _fields(entry).items() if value is not None}
    if isinstance(entry, Mapping):
        known = [field.name for field in fields(Parameter) if field.name != "name"]
        for key in entry:
            if key not in known:
                owner = f"parameter '{name}'"
                raise FieldError(owner, repr(key), f"is no field; {suggestion(key, known)}")
        return dict(entry)
    if is_number(entry):
        return {"value": finite_number("parameters", name, entry), "vary": False}
    raise FieldError(
        "parameters",
        name,
        f"is {entry!r}; a number (it fixes the parameter) or a table of value, min, max and vary "
        "is expected",
    )


def check_parameter_name(name: object) -> None:
    """Refuse what is no parameter's name, with a suggestion."""
    known = _core.parameter_names()
    if not isinstance(name, str) or not _core.is_parameter(name):
        raise FieldError("parameters", repr(name), f"is no parameter; {suggestion(name, known)}")


def suggestion(name: object, known: Collection[str]) -> str:
    """Return what would be right instead of an unknown name: the nearest, or all."""
    close = closest(name, known)
    return f"did you mean '{close}'?" if close else f"known are {', '.join(known)}"


def is_number(value: object) -> bool:
    """Return whether this is a real number; True and False are none."""
    return isinstance(value, numbers.Real) and not isinstance(value, bool)


def finite_number(owner: str, field: str, value: Any) -> float:
    """Return a field's value as a float, or refuse it."""
    if not is_number(value):
        raise FieldError(owner, field, f"is {value!r}; a number is expected")
    try:
        number = float(value)
    except OverflowError:
        number = math.inf
    if not math.isfinite(number):
        # NOTE: no repr here: an integer too large for a float is too long to show.
        raise FieldError(owner, field, f"is {number}; a finite number is expected")
    return number


def order_list(owner: str, field: str, value: Any) -> tuple[float, ...]:
    """Return the orders of harmonics as a tuple of different positive numbers, or refuse them."""
    if isinstance(value, str | bytes) or not isinstance(value, Collection):
        raise FieldError(owner, field, f"is {value!r}; a list of orders like [2] is expected")
    orders = tuple(finite_number(owner, field, order) for order in value)
    if any(order <= 0.0 for order in orders) or len(set(orders)) < len(orders):
        sentence = f"is {list(value)!r}; different orders above 0 are expected, like [2]"
        raise FieldError(owner, field, sentence)
    return orders


def check_flag(owner: str, field: str, value: object) -> None:
    """Refuse what is neither True nor False."""
    if not isinstance(value, bool):
        raise FieldError(owner, field, f"is {value!r}; true or false is expected")


def positive_number(owner: str, field: str, value: object) -> float:
    """Return a field's value as a float, or refuse it."""
    number = finite_number(owner, field, value)
    if number <= 0.0:
        raise FieldError(
            owner, field, f"is {number!r}; more than 0 is expected, leave it out when not known"
        )
    return number


def check_choice(owner: str, field: str, value: object, known: Collection[str]) -> None:
    """Refuse what is none of the known words."""
    if value not in known:
        raise FieldError(
            owner, field, f"is {value!r}, which is unknown; {suggestion(value, known)}"
        )


def not_negative(owner: str, field: str, value: object) -> float:
    """Return a field's value as a float, or refuse it."""
    number = finite_number(owner, field, value)
    if number < 0.0:
        raise FieldError(owner, field, f"is {number!r}; 0 or more is expected")
    return number


def set_numbers(
    instance: Any, owner: str, names: Collection[str], convert: Callable[[str, str, object], float]
) -> None:
    """Turn fields of a frozen instance into checked floats; None stays where it is the default."""
    for field in fields(instance):
        value = getattr(instance, field.name)
        if field.name in names and not (value is None and field.default is None):
            object.__setattr__(instance, field.name, convert(owner, field.name, value))
