"""What a call was given is of the right kind, or one sentence says what would be."""

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from jointid.base.errors import InputError


def require_path(what: str, value: object) -> Path:
    """Return a file's name as a path, or refuse it."""
    if not isinstance(value, str | os.PathLike) or not isinstance(os.fspath(value), str):
        raise InputError(f"{what} is {shown(value)}; the name of a file is expected")
    return Path(value)


def require_mapping(what: str, value: object, example: str) -> Mapping[Any, Any]:
    """Return a mapping, or refuse what is none; `example` shows a right one."""
    if not isinstance(value, Mapping):
        raise InputError(f"{what} is {shown(value)}; a mapping is expected, e.g. {example}")
    return value


def require_kind(what: str, value: object, *kinds: type) -> None:
    """Refuse what is none of these."""
    if not isinstance(value, kinds):
        names = " or ".join(kind.__name__ for kind in kinds)
        raise InputError(f"{what} is {shown(value)}; {_article(names)} is expected")


def shown(value: object) -> str:
    """A value in a message: plain ones as they are, of others their type."""
    if value is None or isinstance(value, str | bool | int | float | list | tuple | dict):
        text = repr(value)
        if len(text) <= 60:
            return text
    return _article(type(value).__name__)


def _article(noun: str) -> str:
    return f"{'an' if noun[0] in 'AEIOaeio' else 'a'} {noun}"
