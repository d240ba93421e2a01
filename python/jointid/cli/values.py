"""Values as text: in a sentence, behind an option, in a joint file."""

from __future__ import annotations

import os
import re
from collections.abc import Mapping
from typing import Any

_LONGEST = 60
_SPECIAL = re.compile(r"[\s'\"\\$`&|;<>()*?\[\]{}!#~]")


def in_sentence(value: object) -> str:
    """A value as a sentence shows it: no quotes, no braces, `none`, `true`, `2, 4`."""
    text = " ".join(_text(value, ", ").split())
    return text if len(text) <= _LONGEST else f"{text[: _LONGEST - 1]}…"


def behind_option(value: object) -> str:
    """A value as the shell and the command line read it."""
    text = _text(value, ",")
    if text and not _SPECIAL.search(text):
        return text
    quoted = text.replace("'", "'\"'\"'")
    return f"'{quoted}'"


def in_joint_file(value: Any) -> str:
    """A value as TOML writes it."""
    if isinstance(value, list | tuple):
        return f"[{', '.join(in_joint_file(entry) for entry in value)}]"
    return f'"{value}"' if isinstance(value, str) else _text(value, ", ")


def _text(value: Any, separator: str) -> str:
    if hasattr(value, "dtype") and getattr(value, "ndim", 1) == 0:  # a number of numpy's
        value = value.item()
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
