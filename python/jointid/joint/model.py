"""The model of a joint's torque: one value for calls, joints, joint files and the command line."""

from __future__ import annotations

import functools
import math
from collections.abc import Collection, Mapping
from dataclasses import KW_ONLY, fields, replace
from numbers import Real
from typing import Any, Literal, Self, get_args

from jointid import _core
from jointid.base.argument_checks import number_in
from jointid.base.errors import InputError
from jointid.base.values import dataclass
from jointid.joint.checks import check_choice, check_flag, finite_number, suggestion
from jointid.joint.own_terms import NO_TERMS, OwnTerms

Gravity = Literal["none", "known", "free"]
Load = Literal["drive", "link"]
ModelName = Literal[
    "coulomb_viscous", "stribeck", "stribeck_general", "smooth_coulomb_viscous", "auto"
]
"""Names of models, for type checkers; `Model.parse` reads text with options."""

AUTO = "auto"
"""Name of a model that `identify` chooses from the recordings; same as no name."""

_GRAVITIES, _LOADS = get_args(Gravity), (None, *get_args(Load))
_GRAVITY_ORDER = 1.0
_LISTS = ("ripple", "harmonics", "per_recording")


@dataclass(frozen=True, slots=True)
class Model:
    """The terms of a joint's torque balance; a field that is None is not stated.

    If a field is None in a call's model, the field of the joint's model applies. If both are None, the default
    applies. The text of a model is its name, followed by its options, each after a colon:
    ``"stribeck:asymmetric:ripple=2,4"``, ``":gravity=free"``.

    Parameters
    ----------
    name : str, optional
        Friction model: "coulomb_viscous", "stribeck", "stribeck_general" (with a free exponent),
        "smooth_coulomb_viscous" (Coulomb friction as a hyperbolic tangent of the velocity), or "auto" (default).
        With "auto", `identify` chooses "coulomb_viscous" or "stribeck", by the better prediction of the torque. A
        simulation makes no choice and uses "coulomb_viscous".
    gravity : {"none", "known", "free"}, optional
        Gravity torque that loads the drive and not the sensor: none, computed from the joint's link ("known"), or
        identified ("free"). Default: none. If `identify` chooses the friction model of a revolute joint, it also
        chooses none or free for gravity. A sensor, a link, a harmonic of order 1 or an own torque term excludes
        this choice.
    asymmetric : bool, optional
        Whether friction differs between the two directions. Default False.
    ripple : collection of float, optional
        Orders of a torque that is periodic in the motor's angle, e.g. (2,) for a strain-wave gear. Each order has
        a sine and a cosine coefficient [N·m]. A single order can be written as a number. Default none.
    harmonics : collection of float, optional
        Orders of a torque that is periodic in the joint's angle. Default none.
    load_friction : bool or {"drive", "link"}, optional
        Whether friction grows with the load. "drive": the load is the magnitude of the drive's torque. "link": the
        load is that of the torque behind the gear, known from a sensor or from gravity. True: the load with the
        better fit. Default False.
    per_recording : collection of str, optional
        Coefficients that have a separate value for each recording, e.g. ("torque_offset",). Default none.
    terms : mapping of str to str, optional
        Own terms: kind of term, by the name of an extra signal s. ``+`` joins several kinds.
        "viscous": coefficient times s. "coulomb": coefficient times sign of s. "coupling": coefficient times rate of s.
        "known": s is a torque. "scaled": s is a torque with a free gain.
        "inertia": s is an inertia J, and the torque is J a. "scaled_inertia": the torque is J a with a free gain.
        "inertia_own": the torque is J a + J' v²/2, if J depends on the joint's own position.
        "inertia_others": the torque is J a + (dJ/dt) v, if J depends on other joints' positions.
        "inertia_over", "torque_over": identified function of the angle s, or of ``position``, centered in its range.
        ``@rate`` after a kind uses the rate of s instead of s. Default none. See docs/own_terms.md.

    Raises
    ------
    InputError
        A field has a wrong type, the name is unknown, or terms are indistinguishable.

    Examples
    --------
    >>> Model("stribeck", ripple=(2, 4)) == Model.parse("stribeck:ripple=2,4")
    True
    """

    name: ModelName | None = None
    _: KW_ONLY
    gravity: Gravity | None = None
    asymmetric: bool | None = None
    ripple: tuple[float, ...] | None = None
    harmonics: tuple[float, ...] | None = None
    load_friction: bool | Load | None = None
    per_recording: tuple[str, ...] | None = None
    terms: OwnTerms | Mapping[str, str] | None = None

    def __post_init__(self) -> None:
        if self.name is not None:
            check_choice("", "name", self.name, (*_core.model_names(), AUTO))
        if self.gravity is not None:
            check_choice("", "gravity", self.gravity, _GRAVITIES)
        if self.asymmetric is not None:
            check_flag("", "asymmetric", self.asymmetric)
        if self.load_friction not in _LOADS:
            check_flag("", "load_friction", self.load_friction)
        for name in ("ripple", "harmonics"):
            if getattr(self, name) is not None:
                object.__setattr__(self, name, _orders(name, getattr(self, name)))
        if self.per_recording is not None:
            object.__setattr__(self, "per_recording", _coefficients(self.per_recording))
        if self.terms is not None:
            object.__setattr__(self, "terms", OwnTerms.of(self.terms))
        if self.gravity in ("known", "free") and _GRAVITY_ORDER in (self.harmonics or ()):
            raise InputError(
                "order 1 of the joint's angle is the same term as gravity",
                argument="harmonics",
                value=list(self.harmonics or ()),
                remedy="leave out order 1, or set gravity to none",
            )

    @classmethod
    def of(cls, value: object, argument: str = "model") -> Model:
        """Return a model from a `Model`, its text, a mapping of its fields, or None.

        Parameters
        ----------
        value : Model, str, mapping or None
        argument : str
            Name of the argument in the error. Default "model".

        Raises
        ------
        InputError
            The value has a wrong type, or a field is invalid.
        """
        if isinstance(value, Model):
            return value
        if value is None:
            return cls()
        if isinstance(value, str):
            return cls.parse(value)
        if isinstance(value, Mapping):
            for key in value:
                _check_field(key)
            return cls(**value)
        raise InputError(
            "a model's text, a Model or a mapping of its fields is expected",
            argument=argument,
            value=value,
        )

    @classmethod
    def parse(cls, text: str) -> Model:
        """Return the model of a text such as ``"stribeck:asymmetric:ripple=2,4"``; inverse of `str`.

        Raises
        ------
        InputError
            The argument is not a text, or an option is unknown or repeated.
        """
        if not isinstance(text, str):
            raise InputError(
                "text is expected, like stribeck:ripple=2,4", argument="model", value=text
            )
        name, *parts = text.split(":")
        options: dict[str, Any] = {}
        for part in parts:
            key, separator, value = part.partition("=")
            if key == "name" or (separator and not value) or not key:
                raise InputError(
                    "write name:option or name:option=value", argument="model", value=text
                )
            _check_field(key)
            if key in options:
                raise InputError("it is given twice", argument=key, value=text)
            options[key] = _read(key, value) if separator else True
        options["name"] = name or None
        return cls(**options)

    def __str__(self) -> str:
        parts: list[str] = [self.name or ""]
        for name, value in self.stated().items():
            if name != "name":
                parts.append(name if value is True else f"{name}={_written(value)}")
        return ":".join(parts)

    def __repr__(self) -> str:
        shown = [f"{key}={value!r}" for key, value in self.stated().items() if key != "name"]
        name = [] if self.name is None else [repr(self.name)]
        return f"Model({', '.join([*name, *shown])})"

    def stated(self) -> dict[str, Any]:
        """Return the fields that are not None, by name."""
        values = ((name, getattr(self, name)) for name in FIELDS)
        return {name: value for name, value in values if value is not None}

    def replace(self, **changes: Any) -> Self:
        """Return a model with some fields changed.

        Raises
        ------
        InputError
            There is no such field, or a value is invalid.
        """
        for key in changes:
            _check_field(key)
        return replace(self, **changes)

    def over(self, base: Model) -> Model:
        """Return this model, with unset fields taken from another model."""
        return Model(**(base.stated() | self.stated()))

    @property
    def named(self) -> bool:
        """Whether the name is set and is not "auto"."""
        return self.name not in (None, AUTO)

    @property
    def resolved(self) -> ResolvedModel:
        """Return the model with all fields. Unset fields have their defaults, also the name "auto"."""
        return _resolved(self)

    def __reduce__(self) -> tuple[Any, ...]:
        return functools.partial(Model, **self.stated()), ()


@dataclass(frozen=True, slots=True, kw_only=True)
class ResolvedModel:
    """A model with a value for every field; fields as in `Model`."""

    name: str = "coulomb_viscous"
    gravity: Gravity = "none"
    asymmetric: bool = False
    ripple: tuple[float, ...] = ()
    harmonics: tuple[float, ...] = ()
    load_friction: bool | Load = False
    per_recording: tuple[str, ...] = ()
    terms: OwnTerms = NO_TERMS

    def __str__(self) -> str:
        """Return the name and the fields that differ from their defaults, as text that `Model.parse` reads."""
        return _text(self)


FIELDS = tuple(item.name for item in fields(Model))
"""Names of a model's fields."""


@functools.lru_cache(maxsize=64)
def _text(model: ResolvedModel) -> str:
    usual = ResolvedModel()
    stated = {item.name: getattr(model, item.name) for item in fields(model)}
    return str(Model(**{n: v for n, v in stated.items() if n == "name" or v != getattr(usual, n)}))


@functools.lru_cache(maxsize=64)
def _resolved(model: Model) -> ResolvedModel:
    stated = model.stated()
    return ResolvedModel(**(stated if model.named else {**stated, "name": ResolvedModel().name}))


def _check_field(key: object) -> None:
    if key not in FIELDS:
        raise InputError(
            f"a model has no such option; {suggestion(key, FIELDS)}",
            argument=str(key),
            place="model",
        )


def _orders(field: str, value: Any) -> tuple[float, ...]:
    """Return the orders of a harmonic as a tuple of distinct positive numbers."""
    single = isinstance(value, Real) and not isinstance(value, bool)
    values = (value,) if single else _listed(field, value, "orders like [2] or 2 are expected")
    try:
        orders = tuple(finite_number("", field, order) for order in values)
    except InputError:
        raise _refused(field, values, "different orders above 0 are expected, like [2]") from None
    if any(order <= 0.0 for order in orders) or len(set(orders)) < len(orders):
        raise _refused(field, values, "different orders above 0 are expected, like [2]")
    # A parameter's name contains its order, with six digits.
    if any(not _core.is_parameter(f"ripple_cos_{o:g}") or float(f"{o:g}") != o for o in orders):
        raise _refused(field, values, "orders have at most six digits")
    return orders


def _coefficients(value: Any) -> tuple[str, ...]:
    names = _listed(
        "per_recording", value, "a list of coefficients like [sensor_offset] is expected"
    )
    shapes = {shape.name for shape in _core.shapes()}
    for name in names:
        if (
            not isinstance(name, str)
            or not _core.is_parameter(name)
            or "[" in name
            or name in shapes
        ):
            raise _refused(
                "per_recording", value, "names of coefficients are expected, like sensor_offset"
            )
    if len(set(names)) < len(names):
        raise _refused("per_recording", value, "a coefficient is given twice")
    return names


def _listed(field: str, value: Any, reason: str) -> tuple[Any, ...]:
    wrong = isinstance(value, str | bytes | Mapping) or not isinstance(value, Collection)
    if wrong or getattr(value, "ndim", 1) != 1:
        raise InputError(reason, argument=field, value=value)
    return tuple(sorted(value, key=str) if isinstance(value, set | frozenset) else value)


def _refused(field: str, value: Collection[Any], reason: str) -> InputError:
    return InputError(reason, argument=field, value=list(value))


def _read(key: str, text: str) -> Any:
    """Return an option's value from its text."""
    if key in _LISTS:
        return (
            () if text == "none" else tuple(_number_or_text(key, part) for part in text.split(","))
        )
    if key == "gravity":
        return text
    if key == "terms":
        return OwnTerms.parse(text)
    return {"true": True, "false": False}.get(text, _number_or_text("", text))


def _number_or_text(key: str, text: str) -> Any:
    """Return a number, or the text if it is not a number."""
    if key == "per_recording":
        return text
    number = None if "_" in text else number_in(text)  # Python reads 1_0 as 10
    return text if number is None or not math.isfinite(number) else number


def _written(value: Any) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, tuple):
        return ",".join(f"{v:g}" if isinstance(v, float) else v for v in value) or "none"
    return str(value)
