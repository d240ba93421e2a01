"""Checks of single fields, shared by values, files and calls."""

from __future__ import annotations

import functools
import math
import numbers
from collections.abc import Callable, Collection, Mapping
from dataclasses import fields
from typing import Any

from jointid import _core
from jointid.base.errors import InputError
from jointid.recording.signals import closest

_FEW = 5  # number of known names that fit into a sentence
_LISTED = 10  # names in a message
_MISSPELT, _SIMILAR = 0.75, 0.6  # similarity of two texts, from difflib


def check_parameter_name(name: object) -> None:
    """Refuse an unknown parameter name, with a suggestion."""
    if not isinstance(name, str) or not _core.is_parameter(name):
        raise InputError(
            f"there is no such parameter; {suggestion(name, _core.parameter_names())}",
            argument=str(name),
            place="parameters",
        )


def suggestion(name: object, known: Collection[str]) -> str:
    """Return a phrase with the known name nearest to an unknown one, or with the first known names.

    If the list is short, only a clear misspelling is answered with a single name.
    """
    close = closest(name, known, _MISSPELT if len(known) <= _FEW else _SIMILAR)
    if close:
        return f"did you mean '{close}'?"
    names = list(known)
    rest = f", … ({len(names)} in all)" if len(names) > _LISTED else ""
    return f"choose one of {', '.join(names[:_LISTED])}{rest}"


def is_number(value: object) -> bool:
    """Return whether this is a real number; True and False are not."""
    if type(value) is float:  # faster than a check with an abstract base class
        return True
    return isinstance(value, numbers.Real) and not isinstance(value, bool)


def finite_number(owner: str, field: str, value: Any) -> float:
    """Return a field's value as a float, or refuse it."""
    if type(value) is float and math.isfinite(value):  # nearly always
        return value
    if not is_number(value):
        raise InputError("a number is expected", argument=field, value=value, place=owner)
    try:
        number = float(value)
    except OverflowError:
        number = math.inf
    if not math.isfinite(number):
        # Show the float, because an integer too large for a float is too long to show.
        raise InputError("a finite number is expected", argument=field, value=number, place=owner)
    return number


def check_flag(owner: str, field: str, value: object) -> None:
    """Refuse a value that is neither True nor False."""
    if not isinstance(value, bool):
        raise InputError("true or false is expected", argument=field, value=value, place=owner)


def check_mapping(owner: str, field: str, value: object) -> None:
    """Refuse a value that is not a mapping."""
    if type(value) is not dict and not isinstance(value, Mapping):
        raise InputError(
            "a mapping from names to values is expected", argument=field, value=value, place=owner
        )


def positive_number(owner: str, field: str, value: object) -> float:
    """Return a field's value as a float, or refuse it."""
    number = finite_number(owner, field, value)
    if number <= 0.0:
        raise InputError(
            "more than 0 is expected; leave this value out if it is not known",
            argument=field,
            value=number,
            place=owner,
        )
    return number


def check_choice(owner: str, field: str, value: object, known: Collection[str]) -> None:
    """Refuse a value that is not one of the known texts."""
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
    """Convert fields of a frozen instance to checked floats; None stays if it is the default."""
    kind: type = type(instance)
    optional = _optional(kind)
    for name in names:
        value = getattr(instance, name)
        if value is not None or not optional[name]:
            object.__setattr__(instance, name, convert(owner, name, value))


@functools.cache
def _optional(kind: type) -> dict[str, bool]:
    """Return field → whether it is None by default."""
    return {field.name: field.default is None for field in fields(kind)}
