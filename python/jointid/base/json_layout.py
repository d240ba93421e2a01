"""JSON as text that people can read and that is written quickly: a line for each entry, a list of numbers on one."""

from json import JSONEncoder
from typing import Any

_plain = JSONEncoder(ensure_ascii=False, allow_nan=False).encode


def json_text(value: Any, indent: str = "") -> str:
    """Return a value as JSON text.

    Parameters
    ----------
    value : object
        Of JSON's types.
    indent : str
        Of the line that it begins in. Default: none.

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
        return _plain(value)
    lines = f",\n{inner}".join(entries)
    return f"{bracket}\n{inner}{lines}\n{indent}{end}"
