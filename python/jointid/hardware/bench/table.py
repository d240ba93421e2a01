"""Table of a joint file, read key by key. Each error names file, table and key."""

from __future__ import annotations

import sys
from collections.abc import Callable, Collection, Mapping
from dataclasses import MISSING, fields
from typing import Any, NoReturn, TypeVar

from jointid.base.errors import NOT_GIVEN, InputError
from jointid.joint.angles import in_radians
from jointid.joint.checks import suggestion

_KINDS: dict[str, tuple[tuple[type, ...], str]] = {
    "float": ((int, float), "a number"),
    "int": ((int,), "a whole number"),
    "str": ((str,), "a text"),
    "bool": ((bool,), "true or false"),
    "tuple[int, ...]": ((list,), "a list of whole numbers"),
    "tuple[float, ...]": ((list,), "a list of numbers"),
    "tuple[float, float]": ((list,), "a list of two numbers"),
}
Made = TypeVar("Made")


class Table:
    """Table of a joint file, with its name and its file for error messages.

    Parameters
    ----------
    entries : mapping
        Keys and values; a text such as "60deg" becomes an angle [rad].
    name : str
        Name in the file, e.g. "session.drive".
    source : str
        Name of the file.

    Attributes
    ----------
    entries : dict
    name, source : str

    Raises
    ------
    InputError
        `entries` is not a table.
    """

    def __init__(self, entries: object, name: str, source: str) -> None:
        if not isinstance(entries, Mapping):
            raise InputError(
                f"a table [{name}] is expected", argument=name, value=entries, place=source
            )
        self.entries = {str(key): in_radians(value) for key, value in entries.items()}
        self.name, self.source = name, source

    @property
    def place(self) -> str:
        """File and table."""
        return f"{self.source}: [{self.name}]"

    def table(self, name: str) -> Table:
        """Return an inner table, or an empty table if there is none."""
        return Table(self.entries.get(name, {}), f"{self.name}.{name}", self.source)

    def without(self, *names: str) -> Table:
        """Return the table without the keys in `names`."""
        left = {name: value for name, value in self.entries.items() if name not in names}
        return Table(left, self.name, self.source)

    def choice(self, name: str, default: str, known: Collection[str]) -> str:
        """Return the value of a key that must be one of the known names."""
        value = self.entries.get(name, default)
        if not isinstance(value, str):
            self.refuse(name, "a text is expected", value)
        if value not in known:
            self.refuse(name, suggestion(value, [*known]), value)
        return value

    def make(self, kind: Callable[..., Made], **fixed: Any) -> Made:
        """Return a dataclass with the values of this table.

        Parameters
        ----------
        kind : dataclass
        **fixed
            Values of fields that are not keys of the table.

        Raises
        ------
        InputError
            A key is unknown, a value has the wrong type, or the dataclass refuses a value.
        """
        known = {name: type_ for name, type_ in types_of(kind).items() if name not in fixed}
        for item in fields(kind):  # type: ignore[arg-type]
            required = item.default is MISSING and item.default_factory is MISSING
            if required and item.name not in {*self.entries, *fixed}:
                self.refuse(item.name, "missing; it has no default")
        return self.call(kind, known, **fixed)

    def make_core(self, kind: Callable[..., Made], unknown: Collection[str] = ()) -> Made:
        """Return an object of the core, e.g. a controller, from keys with the names of its attributes.

        Parameters
        ----------
        kind : callable
            Class with a default for each attribute, and a method `asdict`.
        unknown : collection of str
            Attributes that are not keys of this table.
        """
        defaults: Mapping[str, object] = kind().asdict()  # type: ignore[attr-defined]
        known = {n: type(v).__name__ for n, v in defaults.items() if n not in unknown}
        return self.call(kind, known)

    def call(self, kind: Callable[..., Made], known: Mapping[str, str], **fixed: Any) -> Made:
        """Return the result of a call of `kind` with the entries.

        Parameters
        ----------
        kind : callable
        known : mapping of str to str
            Key → type of its value. The type is "" for a value that `kind` checks.
        **fixed
            Further arguments.
        """
        self.check_names(known)
        entries = dict(self.entries)
        for name, value in entries.items():
            self._check(name, value, known[name])
            if isinstance(value, list):
                entries[name] = tuple(value)
        try:
            return kind(**entries, **fixed)
        except InputError as error:
            raise error.at(self.place) from error

    def check_names(self, known: Collection[str]) -> None:
        """Refuse keys that are not among the known ones."""
        for name in self.entries:
            if name not in known:
                self.refuse(
                    name,
                    f"unknown key; {suggestion(name, known) if known else 'this table has no keys'}",
                )

    def refuse(self, name: str, reason: str, value: object = NOT_GIVEN) -> NoReturn:
        """Raise an InputError about a key of this table, or about its value."""
        raise InputError(reason, argument=name, value=value, place=self.place)

    def _check(self, name: str, value: object, type_: str) -> None:
        for each in value if isinstance(value, list) else [value]:
            if isinstance(each, int) and abs(each) > sys.float_info.max:
                self.refuse(name, "the number is too large")
        expected = _KINDS.get(type_.removesuffix(" | None"))
        if expected is None or (value is None and type_.endswith(" | None")):
            return
        kinds, text = expected
        if not isinstance(value, kinds) or (isinstance(value, bool) and bool not in kinds):
            self.refuse(name, f"{text} is expected", value)


def types_of(kind: Any) -> dict[str, str]:
    """Return the field names of a dataclass and their types as text."""
    return {item.name: type_name(item.type) for item in fields(kind)}


def type_name(annotation: Any) -> str:
    """Return a type as text. With postponed annotations it already is text."""
    return annotation.__name__ if isinstance(annotation, type) else str(annotation)
