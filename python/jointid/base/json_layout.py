"""JSON as text that people can read and that is written quickly: a line for each entry, a list of numbers on one."""

import math
from collections.abc import Mapping
from json import JSONEncoder
from typing import Any

from jointid import _core

_plain = JSONEncoder(ensure_ascii=False, allow_nan=False).encode


def json_types(value: Any) -> Any:
    """Return a value in JSON's types: a tuple is a list, a number that is not finite a text such as "inf"."""
    if hasattr(value, "tolist"):  # of NumPy
        value = value.tolist()
    if isinstance(value, Mapping):
        return {str(name): json_types(each) for name, each in value.items()}
    if isinstance(value, list | tuple):
        return [json_types(each) for each in value]
    if isinstance(value, float) and not math.isfinite(value):
        return str(value)
    return value


def json_text(value: Any, indent: str = "") -> str:
    """Return a value as JSON text.

    Parameters
    ----------
    value : object
        A value of JSON types.
    indent : str
        Indentation of its first line. Default: none.

    Raises
    ------
    ValueError
        A number is not finite.
    """
    inner = f"{indent} "
    if isinstance(value, dict) and value:
        entries = [f"{_plain(str(key))}: {json_text(each, inner)}" for key, each in value.items()]
        bracket, end = "{", "}"
    elif isinstance(value, list) and value and isinstance(value[0], dict | list):
        entries = [json_text(each, inner) for each in value]
        bracket, end = "[", "]"
    else:
        return _on_one_line(value)
    lines = f",\n{inner}".join(entries)
    return f"{bracket}\n{inner}{lines}\n{indent}{end}"


def _on_one_line(value: Any) -> str:
    if isinstance(value, list) and set(map(type, value)) == {float}:
        numbers = _core.number_list(value)  # the same text, five times as fast
        if numbers is not None:
            return numbers
    return _plain(value)
