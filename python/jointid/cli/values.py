"""Values as text: in a sentence, as an option's value, in a joint file."""

from __future__ import annotations

import os
import re
from collections.abc import Mapping
from typing import Any

_LONGEST = 60
_OTHER_KIND = (
    r"(?i)\s*(?:true|false|none|[-+]?(?:inf|nan|(?:\d[\d_]*\.?\d*|\.\d+)(?:e[-+]?\d+)?))\s*"
)
_SPECIAL = r"[\s'\"\\$`&|;<>()*?\[\]{}!#~]"


def in_sentence(value: object) -> str:
    """Return a value as text for a sentence: no braces, `none`, `true`, `2, 4`.

    A text is quoted only if it looks like a number or a flag, because the quotes are then the error.
    """
    if isinstance(value, list | tuple):
        return as_typed(", ".join(_distinct(entry) for entry in value))
    return as_typed(_distinct(value))


def as_typed(value: object) -> str:
    """Return a value as it was typed after an option, on one line and not too long."""
    text = " ".join(_text(value, ", ").split())
    return text if len(text) <= _LONGEST else f"{text[: _LONGEST - 1]}…"


def _distinct(value: object) -> str:
    """Return a value's text, with quotes if it looks like a value of another type."""
    if isinstance(value, str) and re.fullmatch(_OTHER_KIND, value):
        return f'"{value}"'
    return _text(value, " " if isinstance(value, list | tuple) else ", ")


def behind_option(value: object) -> str:
    """Return a value as text for the shell and the command line."""
    text = _text(value, ",")
    if text and not re.search(_SPECIAL, text):
        return text
    quoted = text.replace("'", "'\"'\"'")
    return f"'{quoted}'"


def in_joint_file(value: Any) -> str:
    """Return a value as TOML text."""
    if isinstance(value, list | tuple):
        return f"[{', '.join(in_joint_file(entry) for entry in value)}]"
    return f'"{value}"' if isinstance(value, str) else _text(value, ", ")


def _text(value: Any, separator: str) -> str:
    if hasattr(value, "dtype") and getattr(value, "ndim", 1) == 0:  # a NumPy number
        value = value.item()
    if value is ...:
        return "VALUE"
    if value is None or isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, float):
        return repr(value).removesuffix(".0")
    if isinstance(value, Mapping):
        pairs = (f"{_text(key, ' ')}={_text(entry, ' ')}" for key, entry in value.items())
        return separator.join(pairs)
    if isinstance(value, list | tuple | set | frozenset):
        return separator.join(_text(entry, " ") for entry in value)
    if isinstance(value, str | int | os.PathLike) or "__str__" in vars(type(value)):
        return str(value)
    name = re.sub(r"(?<=[a-z])(?=[A-Z])", " ", type(value).__name__).lower()
    return f"{'an' if name[0] in 'aeio' else 'a'} {name}"
