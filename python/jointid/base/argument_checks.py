"""Checks of the type of an argument."""

import math
import numbers
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from jointid.base.errors import InputError


def require_path(argument: str, value: object) -> Path:
    """Return a file name as a path.

    Raises
    ------
    InputError
        The value is neither text nor a path.
    """
    if not isinstance(value, str | os.PathLike) or not isinstance(os.fspath(value), str):
        raise InputError("the name of a file is expected", argument=argument, value=value)
    return Path(value)


def require_mapping(argument: str, value: object, example: str) -> Mapping[Any, Any]:
    """Return the value if it is a mapping; the error message shows `example`.

    Raises
    ------
    InputError
        The value is not a mapping.
    """
    if not isinstance(value, Mapping):
        raise InputError(f"a mapping is expected, e.g. {example}", argument=argument, value=value)
    return value


def require_kind(argument: str, value: object, *kinds: type) -> None:
    """Check that a value is of one of these types.

    Raises
    ------
    InputError
        The value has none of these types.
    """
    if not isinstance(value, kinds):
        names = " or ".join(kind.__name__ for kind in kinds)
        raise InputError(f"{_article(names)} is expected", argument=argument, value=value)


def whole_number(name: str, value: object, lowest: int, highest: int) -> int:
    """Return a whole number within limits.

    Raises
    ------
    InputError
        The value is not a whole number, or is outside the limits.
    """
    if isinstance(value, bool) or not isinstance(value, numbers.Integral):
        raise InputError("a whole number is expected", argument=name, value=value)
    number = int(value)
    if not lowest <= number <= highest:
        raise InputError(f"{lowest} to {highest} is expected", argument=name, value=number)
    return number


def is_finite(value: object) -> bool:
    """Whether the value is a finite number; an integer too large for a float is not (`math`, NumPy raise for it)."""
    if isinstance(value, bool) or not isinstance(value, numbers.Real):
        return False
    try:
        return math.isfinite(value)
    except OverflowError:
        return False


def _article(noun: str) -> str:
    return f"{'an' if noun[0] in 'AEIOaeio' else 'a'} {noun}"


def number_in(text: str) -> int | float | None:
    """Return the number in a text, or None; an integer too large for a float is infinite."""
    for kind in (int, float):
        try:
            number = kind(text)
            float(number)
        # Not a number, an integer too large for a float, or one with more digits than Python reads.
        except (OverflowError, ValueError):
            continue
        return number
    return None
