"""The fields that a NumPy docstring describes."""

from __future__ import annotations

import inspect
import re
from dataclasses import dataclass

_FIELD = re.compile(r"^(\w[\w, ]*) : (.*)$")


@dataclass(frozen=True)
class Described:
    """Description of one field in a docstring."""

    kind: str
    text: str


def described(subject: object, section: str = "Parameters") -> dict[str, Described]:
    """Return the fields of a section of a docstring by name. Fields on one line share its text."""
    text = inspect.cleandoc(subject.__doc__ or "")
    parts = re.split(r"^(\w[\w ]*)\n-{3,}\n", text, flags=re.MULTILINE)
    wanted = dict(zip(parts[1::2], parts[2::2], strict=True)).get(section, "")
    found: dict[str, Described] = {}
    for block in re.split(r"^(?=\S)", wanted, flags=re.MULTILINE):
        head, _, body = block.partition("\n")
        match = _FIELD.match(head)
        if match:
            names, kind = match.groups()
            entry = Described(kind.strip(), " ".join(body.split()))
            found |= {name.strip(): entry for name in names.split(",")}
    return found
