"""Angles in files: numbers in rad, or texts in degrees such as "60deg"."""

import math
from typing import Any

ANGLE_EXPECTED = 'an angle is expected, in rad or as "60deg"'
_UNIT = "deg"


def in_radians(value: Any) -> Any:
    """Return a file's value with texts such as "60deg" as numbers; any other value unchanged.

    Parameters
    ----------
    value : object
        A value, or a list of them.

    Returns
    -------
    object
        Angles [rad]; a text that is not an angle stays a text.

    Examples
    --------
    >>> in_radians(["-90deg", 0.0, "ga"])
    [-1.5707963267948966, 0.0, 'ga']
    """
    if isinstance(value, str) and value.endswith(_UNIT):
        try:
            return math.radians(float(value.removesuffix(_UNIT)))
        except ValueError:
            return value
    if isinstance(value, list):
        return [in_radians(entry) for entry in value]
    return value


def text_in(value: Any) -> str | None:
    """Return the value if it is a text, or the first text in a list; None if there is none."""
    entries = value if isinstance(value, list) else [value]
    return next((entry for entry in entries if isinstance(entry, str)), None)
