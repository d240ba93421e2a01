"""Reading a TOML file of jointid."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Any

from jointid.base.errors import InputError
from jointid.base.schema import check_depth, read_text

_LONGEST = 300_000  # characters: the time for long keys grows with the square of their length


def check_length(text: str, path: Path) -> None:
    """Raise `InputError` for a text longer than any TOML file of jointid."""
    if len(text) > _LONGEST:
        raise InputError(
            f"too long for a TOML file of jointid: {len(text)} characters; at most {_LONGEST} are allowed",
            place=str(path),
        )


def read_toml(path: Path) -> dict[str, Any]:
    """Return the tables of a TOML file; a schema checks them.

    Raises
    ------
    InputError
        The file cannot be read, or is not TOML; the error names the file, and the line if known.
    """
    text = read_text(path)
    check_length(text, path)
    try:
        tables = tomllib.loads(text.removeprefix("\ufeff"))  # byte order mark of Windows editors
        check_depth(tables, "not TOML of jointid")
    except RecursionError:
        raise InputError("not TOML: it is nested too deeply", place=str(path)) from None
    except InputError as error:
        raise error.at(str(path)) from None
    except ValueError as error:  # a TOMLDecodeError, or a number with too many digits
        reason, _, position = str(error).partition(" (at ")
        where = position.rstrip(")") or "the end of the file"
        raise InputError(f"not TOML: {reason} ({where})", place=str(path)) from None
    return tables
