"""Checks that an argument is of the expected kind."""

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
        It is neither text nor a path.
    """
    if not isinstance(value, str | os.PathLike) or not isinstance(os.fspath(value), str):
        raise InputError("the name of a file is expected", argument=argument, value=value)
    return Path(value)


def require_mapping(argument: str, value: object, example: str) -> Mapping[Any, Any]:
    """Return a value that is a mapping; `example` shows a correct one in the message.

    Raises
    ------
    InputError
        It is not a mapping.
    """
    if not isinstance(value, Mapping):
        raise InputError(f"a mapping is expected, e.g. {example}", argument=argument, value=value)
    return value


def require_kind(argument: str, value: object, *kinds: type) -> None:
    """Check that a value is of one of these types.

    Raises
    ------
    InputError
        It is of none of them.
    """
    if not isinstance(value, kinds):
        names = " or ".join(kind.__name__ for kind in kinds)
        raise InputError(f"{_article(names)} is expected", argument=argument, value=value)


def whole_number(name: str, value: object, lowest: int, highest: int) -> int:
    """A whole number within limits.

    Raises
    ------
    InputError
        Not a whole number, or outside.
    """
    if isinstance(value, bool) or not isinstance(value, numbers.Integral):
        raise InputError("a whole number is expected", argument=name, value=value)
    number = int(value)
    if not lowest <= number <= highest:
        raise InputError(f"{lowest} to {highest} is expected", argument=name, value=number)
    return number


def is_finite(value: object) -> bool:
    """Whether it is a finite number: no integer beyond all floats, which `math` and NumPy refuse in other ways."""
    if isinstance(value, bool) or not isinstance(value, numbers.Real):
        return False
    try:
        return math.isfinite(value)
    except OverflowError:
        return False


def _article(noun: str) -> str:
    return f"{'an' if noun[0] in 'AEIOaeio' else 'a'} {noun}"


def number_in(text: str) -> int | float | None:
    """Return the number that a text states, or None; an integer beyond all floats is infinite."""
    for kind in (int, float):
        try:
            number = kind(text)
            float(number)
        # Not a number; an integer beyond all floats; an integer of more digits than Python reads.
        except (OverflowError, ValueError):
            continue
        return number
    return None
