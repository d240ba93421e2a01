"""A valid example of a file, and the same file with one value replaced."""

import json
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from jointid.base.toml_text import toml_of
from read_back import values

Place = tuple[str | int, ...]
_MARK = "@here@"
_LONG = 4  # of more numbers than these, the first and the last stand for all


@dataclass(frozen=True, kw_only=True)
class Example:
    """A file that jointid has written and reads again.

    Attributes
    ----------
    name : str
        Of the file.
    documents : sequence
        What stands in it, one value a line: of JSON's types, or a text that is never changed.
    marks : sequence of str
        What stands before each line. Default: nothing.
    elsewhere : tuple
        A table that another example shows; nothing below it is replaced. Default: none.
    use : callable
        Reads the file and uses what it holds.
    modules : sequence of str
        Below jointid: who reads it. Each is seen to run when the example is used.
    beside : mapping of str to bytes
        Other files of its folder. Default: none.
    """

    name: str
    documents: Sequence[Any]
    use: Callable[[Path], object]
    modules: Sequence[str]
    marks: Sequence[str] = ()
    elsewhere: Place = ()
    beside: dict[str, bytes] = field(default_factory=dict)

    @property
    def values(self) -> tuple[str, ...]:
        """What is put in the place of each value."""
        return values.TOML if self.name.endswith(".toml") else values.JSON

    @property
    def places(self) -> list[tuple[int, Place]]:
        """Line and place of every value."""
        return [
            (line, place)
            for line, document in enumerate(self.documents)
            if not isinstance(document, str)
            for place in _places(document)
            if place or not self.name.endswith(".toml")  # a TOML file is always a table
            if not self.elsewhere
            or place[: len(self.elsewhere)] != self.elsewhere
            or place == self.elsewhere
        ]

    def changes(self, every: int = 1) -> Iterator[tuple[int, Place, str]]:
        """Yield line, place and value of the changes: each value at each place, or at every n-th one."""
        for number, (line, place) in enumerate(self.places):
            for shift, value in enumerate(self.values):
                # Only a key can be left out.
                possible = value != values.REMOVED or (place and isinstance(place[-1], str))
                if possible and (number + shift) % every == 0:
                    yield line, place, value

    def text(self, line: int = -1, place: Place = (), value: str = "") -> str:
        """The file; with a line, the value at a place of it replaced."""
        found = []
        for number, document in enumerate(self.documents):
            changed = _changed(document, place, value) if number == line else document
            if isinstance(document, str):
                written = document
            elif self.name.endswith(".toml"):
                written = toml_of(changed)
            else:
                written = json.dumps(changed)
            mark = self.marks[number] if self.marks else ""
            found.append(mark + written.replace(f'"{_MARK}"', value))
        return "\n".join(found) + "\n"


def _places(value: Any, here: Place = ()) -> Iterator[Place]:
    yield here
    if isinstance(value, dict):
        for key, inner in _unlike(value).items():
            yield from _places(inner, (*here, key))
    elif isinstance(value, list):
        plain = len(value) > _LONG and all(isinstance(each, float | int) for each in value)
        for number in (0, len(value) - 1) if plain else range(len(value)):
            yield from _places(value[number], (*here, number))


def _unlike(table: dict[str, Any]) -> dict[str, Any]:
    """A table without those of its tables that have the keys of the one before: one stands for all."""
    kept: dict[str, Any] = {}
    known: list[set[str]] = []
    for key, inner in table.items():
        if isinstance(inner, dict) and inner:
            if inner.keys() in known:
                continue
            known.append(set(inner))
        kept[key] = inner
    return kept


def _changed(document: Any, place: Place, value: str) -> Any:
    """A copy with a mark at the place, or without it."""
    if not place:
        return _MARK
    first, *rest = place
    copy = document.copy()
    if not rest and value == values.REMOVED:
        del copy[first]
    else:
        copy[first] = _changed(document[first], tuple(rest), value)
    return copy
