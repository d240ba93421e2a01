"""Tables as TOML text, for files of ours that are written whole."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Iterator, Mapping
from typing import Any

_BARE = r"[A-Za-z0-9_-]+"


def toml_of(tables: Mapping[str, Any], comments: Mapping[str, str] | None = None) -> str:
    """Return tables as TOML.

    Parameters
    ----------
    tables : mapping
        Values are numbers, texts, flags, lists of these, and mappings of these; None is left out, and a
        number that is not finite becomes a text: "inf", as `schema.Number` reads it.
    comments : mapping of str to str, optional
        By the name of a table or a key, such as "limits" or "limits.velocity". Default: none.

    Returns
    -------
    str
        Ends with a line feed; `tomllib` reads the same values.

    Examples
    --------
    >>> print(toml_of({"limits": {"velocity": 3.4}}, {"limits.velocity": "rad/s"}), end="")
    [limits]
    velocity = 3.4  # rad/s
    """
    return "\n".join(_lines(tables, "", comments or {})).strip("\n") + "\n"


def _lines(table: Mapping[str, Any], path: str, comments: Mapping[str, str]) -> Iterator[str]:
    inner = {key: value for key, value in table.items() if isinstance(value, Mapping)}
    for key, value in table.items():
        if key in inner or value is None:
            continue
        said = comments.get(f"{path}.{key}" if path else key, "")
        yield f"{_key(key)} = {_value(value)}" + (f"  # {said}" if said else "")
    for key, value in inner.items():
        whole = f"{path}.{_key(key)}" if path else _key(key)
        said = comments.get(whole, "")
        plain = any(not isinstance(each, Mapping) for each in value.values())
        if plain or not value:  # a table of tables alone needs no head of its own
            yield ""
            yield f"[{whole}]" + (f"  # {said}" if said else "")
        yield from _lines(value, whole, comments)


def _key(name: str) -> str:
    return name if re.fullmatch(_BARE, name) else _text(name)


def _value(value: Any) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, float):
        # A number of numpy's is one, too, and writes itself otherwise.
        return repr(float(value)) if math.isfinite(value) else f'"{float(value)}"'
    if isinstance(value, int):
        return str(value)
    if isinstance(value, list | tuple):
        return f"[{', '.join(_value(each) for each in value)}]"
    return _text(str(value))


def _text(value: str) -> str:
    # JSON's quotes are TOML's, but for one character that TOML does not allow as it is.
    return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
