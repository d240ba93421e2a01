"""Tables as TOML text, for jointid files that are written completely."""

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
        Numbers, texts, flags, lists of these, and mappings of these. None is left out. A number that is not
        finite becomes a text such as "inf", which `schema.Number` reads.
    comments : mapping of str to str, optional
        Comments by the name of a table or key, such as "limits" or "limits.velocity". Default: none.

    Returns
    -------
    str
        TOML text with a final line feed; `tomllib` reads the same values.

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
        if plain or not value:  # a table that holds only tables needs no head
            yield ""
            yield f"[{whole}]" + (f"  # {said}" if said else "")
        yield from _lines(value, whole, comments)


def _key(name: str) -> str:
    return name if re.fullmatch(_BARE, name) else _text(name)


def _value(value: Any) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, float):
        # A NumPy number has another repr.
        return repr(float(value)) if math.isfinite(value) else f'"{float(value)}"'
    if isinstance(value, int):
        return str(value)
    if isinstance(value, list | tuple):
        return f"[{', '.join(_value(each) for each in value)}]"
    return _text(str(value))


def _text(value: str) -> str:
    # A JSON string is a TOML string, except for one character that TOML must escape.
    return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
