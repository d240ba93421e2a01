"""Checks of single fields, alike for everything that states a joint: values, files, calls."""

from __future__ import annotations

import math
import numbers
from collections.abc import Callable, Collection
from dataclasses import fields
from typing import Any

from jointid import _core
from jointid.base.errors import InputError
from jointid.recording.signals import closest


def check_parameter_name(name: object) -> None:
    """Refuse what is no parameter's name, with a suggestion."""
    known = _core.parameter_names()
    if not isinstance(name, str) or not _core.is_parameter(name):
        raise InputError(
            f"there is no such parameter; {suggestion(name, known)}",
            argument=str(name),
            place="parameters",
        )


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
        raise InputError("a number is expected", argument=field, value=value, place=owner)
    try:
        number = float(value)
    except OverflowError:
        number = math.inf
    if not math.isfinite(number):
        # The float, since an integer too large for one is too long to show.
        raise InputError("a finite number is expected", argument=field, value=number, place=owner)
    return number


def check_flag(owner: str, field: str, value: object) -> None:
    """Refuse what is neither True nor False."""
    if not isinstance(value, bool):
        raise InputError("true or false is expected", argument=field, value=value, place=owner)


def positive_number(owner: str, field: str, value: object) -> float:
    """Return a field's value as a float, or refuse it."""
    number = finite_number(owner, field, value)
    if number <= 0.0:
        raise InputError(
            "more than 0 is expected; leave it out when it is not known",
            argument=field,
            value=number,
            place=owner,
        )
    return number


def check_choice(owner: str, field: str, value: object, known: Collection[str]) -> None:
    """Refuse what is none of the known words."""
    if not isinstance(value, str) or value not in known:
        raise InputError(
            f"it is unknown; {suggestion(value, known)}", argument=field, value=value, place=owner
        )


def not_negative(owner: str, field: str, value: object) -> float:
    """Return a field's value as a float, or refuse it."""
    number = finite_number(owner, field, value)
    if number < 0.0:
        raise InputError("0 or more is expected", argument=field, value=number, place=owner)
    return number


def set_numbers(
    instance: Any, owner: str, names: Collection[str], convert: Callable[[str, str, object], float]
) -> None:
    """Turn fields of a frozen instance into checked floats; None stays where it is the default."""
    for field in fields(instance):
        value = getattr(instance, field.name)
        if field.name in names and not (value is None and field.default is None):
            object.__setattr__(instance, field.name, convert(owner, field.name, value))
