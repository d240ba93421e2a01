"""Readable JSON text that is written quickly: one line per entry, a list of numbers on one line."""

import math
from collections.abc import Mapping
from json import JSONEncoder
from typing import Any

from jointid import _core

_plain = JSONEncoder(ensure_ascii=False, allow_nan=False).encode


def json_types(value: Any) -> Any:
    """Return a value in JSON's types: tuples become lists, numbers that are not finite become text such as "inf"."""
    if hasattr(value, "tolist"):  # a NumPy value
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
        Value of JSON's types.
    indent : str
        Indentation of the first line. Default: none.

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
