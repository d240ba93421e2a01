"""Schemas of jointid's own files: declared once, checked during reading.

A schema is built from the kinds below. Each has one method, `read(value, place)`, which returns the
checked value or raises an InputError with the JSON path as place, e.g. "parameters.coulomb.value".
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Mapping
from dataclasses import field
from pathlib import Path
from typing import Any, NoReturn, Protocol

from jointid.base.errors import NOT_GIVEN, InputError
from jointid.base.values import dataclass

LARGEST = 500_000_000  # bytes or characters; an estimate from one hour has 20 million
DEEPEST = 32  # levels of nested lists and tables; an estimate has 5
_CHUNK = 1 << 16  # bytes; most files have fewer
_NOT_FINITE = ("inf", "-inf", "nan")


class Kind(Protocol):
    """A kind of value."""

    def read(self, value: Any, place: str) -> Any:
        """Return the checked value, or raise an InputError with the place."""


def read_text(path: Path) -> str:
    """Return the text of a jointid file.

    Raises
    ------
    InputError
        The file cannot be read, is too large, or is not UTF-8; the error names the file.
    """
    place = str(path)
    try:
        return read_bytes(path).decode("utf-8")
    except UnicodeDecodeError:
        raise InputError("this is not text in UTF-8", place=place) from None
    except FileNotFoundError:
        raise InputError("there is no such file", place=place) from None
    except OSError as error:
        raise InputError(f"it cannot be read: {error.strerror}", place=place) from error


def read_bytes(path: Path) -> bytes:
    """Return the bytes of a jointid file.

    Raises
    ------
    InputError
        The file is too large; the error names the file.
            OSError
                The file cannot be read.
    """
    data = bytearray()
    with path.open("rb") as file:  # a device or a pipe does not state its size
        while chunk := file.read(min(_CHUNK, LARGEST + 1 - len(data))):
            data += chunk
            if len(data) > LARGEST:
                raise InputError(f"too large: at most {LARGEST} bytes are allowed", place=str(path))
    return bytes(data)


def read_json(text: str) -> Any:
    """Return the value of a JSON text, within the limits of size and depth of jointid files.

    Parameters
    ----------
    text : str

    Returns
    -------
    object
        Value of JSON's types; numbers may be infinite or NaN, which `Number` and `Plain` refuse.

    Raises
    ------
    InputError
        The text is not JSON, is nested too deeply, or is too large.
    """
    if len(text) > LARGEST:
        raise InputError(f"too large: {len(text)} characters; at most {LARGEST} are allowed")
    try:
        value = json.loads(text)
    except RecursionError:
        raise InputError("not JSON of jointid: nested too deeply") from None
    except json.JSONDecodeError as error:
        raise InputError(f"not JSON: line {error.lineno}, column {error.colno}") from None
    except ValueError:  # an integer with 5000 digits
        raise InputError("not JSON of jointid: a number has too many digits") from None
    check_depth(value, "not JSON of jointid")
    return value


def read_document(text: str, kind: str, schema: int, what: str) -> dict[str, Any]:
    """Return the document in a JSON text, of this kind and of a schema up to the present one.

    Parameters
    ----------
    text : str
    kind : str
        Expected value of the document's field "kind".
    schema : int
        The newest known schema.
    what : str
        Description of the document for a message, e.g. "a comparison of models".

    Raises
    ------
    InputError
        The text is not JSON, is another kind, or has a newer schema.
    """
    document = read_json(text)
    if not isinstance(document, dict) or document.get("kind") != kind:
        raise InputError(f"this JSON is not {what}: its field 'kind' is not '{kind}'")
    number = Number(low=1, whole=True).read(document.get("schema"), "schema")
    if number > schema:
        reason = f"this version of jointid reads schemas up to {schema}"
        raise InputError(reason, value=number, place="schema", remedy="update jointid")
    return document


def check_depth(value: Any, what: str) -> None:
    """Check that lists and tables are not nested deeper than in any jointid file.

    Raises
    ------
    InputError
        They are nested deeper; the message begins with `what`.
    """
    level: list[Any] = [value]
    for _ in range(DEEPEST + 1):
        inside = [_items(each) for each in level if isinstance(each, list | dict)]
        if not inside:
            return
        level = [each for items in inside for each in items]
    raise InputError(f"{what}: nested too deeply")


def _items(value: list[Any] | dict[str, Any]) -> Iterable[Any]:
    return value.values() if isinstance(value, dict) else value


@dataclass(frozen=True, slots=True, kw_only=True)
class Number:
    """A number between `low` and `high`, both included; an integer when `whole`.

    With `infinite`, the texts "inf" and "-inf" mean infinite numbers, which JSON lacks. With `undefined`,
    "nan" means an undefined number.
    """

    low: float = -math.inf
    high: float = math.inf
    whole: bool = False
    infinite: bool = False
    undefined: bool = False

    def holds(self, values: list[Any]) -> bool:
        """Whether a list holds only numbers that `read` returns unchanged: a fast check for thousands."""
        if set(map(type, values)) != {int if self.whole else float}:
            return False
        if not (self.whole or all(map(math.isfinite, values))):
            return False
        return bool(self.low <= min(values) and max(values) <= self.high)

    def read(self, value: Any, place: str) -> float | int:
        """Return a float, or an int if `whole`."""
        number = value
        if isinstance(value, str) and value in _NOT_FINITE:
            number = float(value)
            if not (self.undefined if math.isnan(number) else self.infinite):
                _refuse(place, value, "a finite number is expected")
        elif isinstance(value, bool) or not isinstance(value, int | float):
            _refuse(place, value, "a number is expected")
        elif isinstance(value, float) and not math.isfinite(value):
            _refuse(place, value, "a finite number is expected")
        elif self.whole and not isinstance(value, int):
            _refuse(place, value, "an integer is expected")
        if number < self.low or number > self.high:
            _refuse(place, value, f"a number from {self.low:g} to {self.high:g} is expected")
        if self.whole:
            return int(number)
        try:
            return float(number)
        except OverflowError:
            _refuse(place, NOT_GIVEN, "the number is too large")


@dataclass(frozen=True, slots=True, kw_only=True)
class Text:
    """A text of at most `longest` characters; one of `known` if that is not empty."""

    longest: int = 10_000
    known: tuple[str, ...] = ()

    def read(self, value: Any, place: str) -> str:
        """Return the text."""
        if not isinstance(value, str):
            _refuse(place, value, "text is expected")
        if len(value) > self.longest:
            reason = f"the text has {len(value)} characters; at most {self.longest} are expected"
            _refuse(place, NOT_GIVEN, reason)
        if not value.isascii() and any("\ud800" <= letter <= "\udfff" for letter in value):
            _refuse(place, NOT_GIVEN, "the text has half a character, which no file can store")
        if self.known and value not in self.known:
            _refuse(place, value, f"choose one of {', '.join(self.known)}")
        return value


@dataclass(frozen=True, slots=True, kw_only=True)
class Flag:
    """True or false."""

    def read(self, value: Any, place: str) -> bool:
        """Return the flag."""
        if not isinstance(value, bool):
            _refuse(place, value, "true or false is expected")
        return value


@dataclass(frozen=True, slots=True)
class OrNull:
    """A value of `kind`, or null."""

    kind: Kind

    def read(self, value: Any, place: str) -> Any:
        """Return the value, or None."""
        return None if value is None else self.kind.read(value, place)


@dataclass(frozen=True, slots=True)
class ListOf:
    """A list of `shortest` to `longest` items of one kind."""

    item: Kind
    shortest: int = 0
    longest: int = 10_000_000

    def read(self, value: Any, place: str) -> list[Any]:
        """Return a list."""
        if not isinstance(value, list):
            _refuse(place, value, "a list is expected")
        if not self.shortest <= len(value) <= self.longest:
            many = f"{self.shortest} to {self.longest} items are expected, not {len(value)}"
            _refuse(place, NOT_GIVEN, many)
        if isinstance(self.item, Number) and self.item.holds(value):
            return value
        return [self.item.read(each, f"{place}[{i}]") for i, each in enumerate(value)]


@dataclass(frozen=True, slots=True)
class TableOf:
    """A table of at most `longest` entries of one kind, with any names of at most `longest_name` characters."""

    entry: Kind
    longest: int = 10_000
    longest_name: int = 200

    def read(self, value: Any, place: str) -> dict[str, Any]:
        """Return a dict in the file's order."""
        table = _table(value, place)
        if len(table) > self.longest:
            reason = f"at most {self.longest} entries are expected, not {len(table)}"
            _refuse(place, NOT_GIVEN, reason)
        name = Text(longest=self.longest_name)
        return {
            name.read(key, place): self.entry.read(entry, _inside(place, key))
            for key, entry in table.items()
        }


@dataclass(frozen=True, slots=True)
class Record:
    """A table with known keys: `fields` are required, `optional` are not; others are of kind `other` or refused."""

    fields: Mapping[str, Kind]
    optional: Mapping[str, Kind] = field(default_factory=dict)
    other: Kind | None = None

    def read(self, value: Any, place: str) -> dict[str, Any]:
        """Return a dict of the present keys."""
        table = _table(value, place)
        for key in self.fields:
            if key not in table:
                _refuse(_inside(place, key), NOT_GIVEN, "this is missing")
        known = {**self.optional, **self.fields}
        result = {}
        for key, entry in table.items():
            kind = known.get(key, self.other)
            Text(longest=200).read(key, place)
            if kind is None:
                _refuse(
                    _inside(place, key), NOT_GIVEN, f"unknown key; choose one of {', '.join(known)}"
                )
            result[key] = kind.read(entry, _inside(place, key))
        return result


@dataclass(frozen=True, slots=True, kw_only=True)
class Unchecked:
    """Any value; another reader checks it."""

    def read(self, value: Any, place: str) -> Any:
        """Return the value."""
        del place
        return value


@dataclass(frozen=True, slots=True, kw_only=True)
class Plain:
    """Any value of JSON's types with finite numbers: another reader checks it, or it is only shown."""

    def read(self, value: Any, place: str) -> Any:
        """Return the value."""
        if isinstance(value, list):
            return ListOf(self).read(value, place)
        if isinstance(value, dict):
            return TableOf(self).read(value, place)
        if isinstance(value, str):
            return Text().read(value, place)
        if isinstance(value, int | float) and not isinstance(value, bool):
            Number().read(value, place)
        return value


@dataclass(frozen=True, slots=True, kw_only=True)
class Json:
    """Any value of JSON's types, of any length; its numbers are finite unless `finite` is False."""

    finite: bool = True

    def read(self, value: Any, place: str) -> Any:
        """Return the value."""
        if isinstance(value, list):
            return [self.read(each, f"{place}[{i}]") for i, each in enumerate(value)]
        if isinstance(value, dict):
            text = Text(longest=LARGEST)
            return {
                text.read(key, place): self.read(entry, _inside(place, key))
                for key, entry in value.items()
            }
        if isinstance(value, str):
            return Text(longest=LARGEST).read(value, place)
        if self.finite and isinstance(value, int | float) and not isinstance(value, bool):
            Number().read(value, place)
        return value


def _table(value: Any, place: str) -> dict[str, Any]:
    if not isinstance(value, dict):
        _refuse(place, value, "a table is expected")
    return value


def _inside(place: str, key: str) -> str:
    name = key if len(key) <= 60 else f"{key[:60]}…"
    return f"{place}.{name}" if place else name


def _refuse(place: str, value: object, reason: str) -> NoReturn:
    raise InputError(reason, value=value, place=place)
