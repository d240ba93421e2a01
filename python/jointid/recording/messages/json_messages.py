"""Messages in JSON: their numbers and names by path."""

import json
from typing import Any

from jointid.recording.messages.joints import Path, may_name
from jointid.recording.messages.topic import DamageError

_DEEPEST = 32
_MOST = 8192  # numbers in a message


def flattened(message: bytes) -> tuple[tuple[Path, ...], tuple[float, ...], dict[Path, str]]:
    """Return the paths of a message's numbers, the numbers, and the texts that may name joints.

    Raises
    ------
    DamageError
        The message is not a JSON object, or is very large.
    """
    try:
        value = json.loads(message)
    except (ValueError, RecursionError):
        raise DamageError("it is not JSON") from None
    if not isinstance(value, dict):
        raise DamageError("it is not a JSON object")
    paths: list[Path] = []
    numbers: list[float] = []
    names: dict[Path, str] = {}
    _flatten(value, (), paths, numbers, names)
    return tuple(paths), tuple(numbers), names


def _flatten(
    value: Any, path: Path, paths: list[Path], numbers: list[float], names: dict[Path, str]
) -> None:
    if isinstance(value, str):
        if may_name(path):
            names[path] = value
    elif isinstance(value, int | float):
        paths.append(path)
        try:
            numbers.append(value if path[-1] in _WHOLE else float(value))
        except OverflowError:
            raise DamageError("a number is too large") from None
        if len(paths) > _MOST:
            raise DamageError(f"it holds more than {_MOST} numbers")
    elif value is None and path:
        paths.append(path)
        numbers.append(float("nan"))
    elif isinstance(value, dict | list) and len(path) < _DEEPEST:
        parts = value.items() if isinstance(value, dict) else enumerate(value)
        for key, part in parts:
            _flatten(part, (*path, key), paths, numbers, names)


_WHOLE = ("sec", "nsec", "nanosec", "secs", "nsecs")  # parts of a stamp, kept exact
