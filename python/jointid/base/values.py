"""Frozen dataclasses that cost little until they are used.

`dataclasses.dataclass` compiles up to seven functions for each class at import: 0.3 ms per class, a seventh of the
time of `jointid identify`. Here the methods are closures over the field names. Only `__init__` is compiled, and only
when it is called often or its signature is needed. All other behavior is the same: `dataclasses.fields`, `replace`
and `asdict`, comparison, hash, text and pickles.
"""

import dataclasses
import operator
import sys
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import partial
from reprlib import recursive_repr
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from dataclasses import dataclass as dataclass
else:

    def dataclass(cls: type | None = None, /, **options: bool) -> Any:
        """Make a class a dataclass, like `dataclasses.dataclass` with the same options.

        Parameters
        ----------
        cls : type
        **options
            ``frozen``, ``slots``, ``kw_only``, ``eq`` and ``repr``.
        """

        def decorate(cls: type) -> type:
            # Classes that inherit fields or are mutable are rare: use the standard decorator.
            plain = not options.get("frozen") or any(map(dataclasses.is_dataclass, cls.__bases__))
            return (dataclasses.dataclass if plain else _frozen)(cls, **options)

        return decorate if cls is None else decorate(cls)


def _frozen(cls: type[Any], **options: bool) -> type[Any]:
    compares, shows = options.get("eq", True), options.get("repr", True)
    options |= {"init": False, "eq": False, "repr": False, "frozen": False}
    cls.__doc__ = cls.__doc__ or cls.__name__  # otherwise slow: made from the signature
    cls = dataclasses.dataclass(**options)(cls)
    said = cls.__dataclass_params__
    said.init, said.eq, said.repr, said.frozen = True, compares, shows, True
    fields = dataclasses.fields(cls)
    names = [field.name for field in fields]
    methods: dict[str, Any] = {"__init__": _Initialiser(cls), **_guards(cls, frozenset(names))}
    if shows:
        methods["__repr__"] = _representation([field.name for field in fields if field.repr])
    if compares:
        methods |= _comparison(fields)
    if options.get("slots"):
        methods |= _pickling(names)
    for name, method in methods.items():
        # Python sets the hash of a class with its own comparison to None.
        if vars(cls).get(name) is None:
            method.__name__, method.__qualname__ = name, f"{cls.__qualname__}.{name}"
            setattr(cls, name, method)
    return cls


_OFTEN = 50
"""Calls of an `__init__` before it is compiled."""


class _Initialiser:
    """A class's `__init__` until it is called often, or its signature is needed.

    Compilation takes as long as a hundred of these calls, and most classes have few instances in a process.
    """

    def __init__(self, owner: type[Any]) -> None:
        self._owner = owner
        self._calls = 0
        self._arguments: _Arguments | None = None

    def __get__(self, value: object, cls: type[Any]) -> Any:
        self._calls += 1
        # `inspect.signature` of Python 3.13 accesses this through the class instead of an instance.
        if value is None or isinstance(value, type) or self._calls > _OFTEN:
            return self._compiled().__get__(value, cls)
        return partial(self._initialise, value)

    def _compiled(self) -> Callable[..., None]:
        initialise = _compiled(self._owner)
        setattr(self._owner, "__init__", initialise)  # noqa: B010 (of a class, to the type checker)
        return initialise

    def _initialise(self, value: object, /, *unnamed: object, **named: object) -> None:
        if self._arguments is None:
            self._arguments = _Arguments(dataclasses.fields(self._owner))
        values = self._arguments.values(unnamed, named)
        if values is None:
            self._compiled()(value, *unnamed, **named)  # raises the usual error
            return
        for name, found in values:
            object.__setattr__(value, name, found)
        if hasattr(value, "__post_init__"):
            value.__post_init__()


class _Arguments:
    """Arguments of an `__init__`."""

    def __init__(self, fields: Sequence[dataclasses.Field[Any]]) -> None:
        self._fields = [(field.name, field.default, field.default_factory) for field in fields]
        self._names = frozenset([field.name for field in fields])
        self._unnamed = [field.name for field in fields if not field.kw_only]

    def values(
        self, unnamed: Sequence[object], named: Mapping[str, object]
    ) -> Iterable[tuple[str, object]] | None:
        """Return each field's value; None if an argument is missing, or there are too many."""
        if not unnamed and named.keys() == self._names:
            return named.items()
        given = dict(zip(self._unnamed, unnamed, strict=False))
        if len(given) < len(unnamed) or given.keys() & named.keys() or named.keys() - self._names:
            return None
        given.update(named)
        found: list[tuple[str, object]] = []
        for name, default, make in self._fields:
            if name in given:
                found.append((name, given[name]))
            elif default is not dataclasses.MISSING:
                found.append((name, default))
            elif make is not dataclasses.MISSING:
                found.append((name, make()))
            else:
                return None
        return found


class _Absent:
    """Marker for a missing argument of a field with a default factory."""

    def __repr__(self) -> str:
        return "<factory>"


_ABSENT = _Absent()


def _compiled(cls: type[Any]) -> Callable[..., None]:
    """Return the `__init__` of a class, same as from `dataclasses`."""
    known: dict[str, Any] = {"_set": object.__setattr__, "_absent": _ABSENT}
    before: list[str] = []
    behind: list[str] = []
    body: list[str] = []
    for field in dataclasses.fields(cls):
        name, value = field.name, field.name
        argument = name
        if field.default is not dataclasses.MISSING:
            known[f"_default_{name}"] = field.default
            argument += f"=_default_{name}"
        elif field.default_factory is not dataclasses.MISSING:
            known[f"_make_{name}"] = field.default_factory
            argument += "=_absent"
            value = f"_make_{name}() if {name} is _absent else {name}"
        (behind if field.kw_only else before).append(argument)
        body.append(f"  _set(_self, {name!r}, {value})")
    if hasattr(cls, "__post_init__"):
        body.append("  _self.__post_init__()")
    arguments = ", ".join(["_self", *before, *["*"] * bool(behind), *behind])
    text = "\n".join(
        [
            f"def make({', '.join(known)}):",
            f" def __init__({arguments}):",
            *(body or ["  pass"]),
            " return __init__",
        ]
    )
    space: dict[str, Any] = {}
    exec(text, vars(sys.modules[cls.__module__]), space)
    initialise: Callable[..., None] = space["make"](**known)
    initialise.__qualname__ = f"{cls.__qualname__}.__init__"
    types = {field.name: field.type for field in dataclasses.fields(cls)}
    initialise.__annotations__ = {**types, "return": None}
    return initialise


def _guards(cls: type[Any], names: frozenset[str]) -> dict[str, Any]:
    """Return the methods that refuse to change an instance."""

    def change(self: object, name: str, value: object) -> None:
        if type(self) is cls or name in names:
            raise dataclasses.FrozenInstanceError(f"cannot assign to field {name!r}")
        super(cls, self).__setattr__(name, value)

    def delete(self: object, name: str) -> None:
        if type(self) is cls or name in names:
            raise dataclasses.FrozenInstanceError(f"cannot delete field {name!r}")
        super(cls, self).__delattr__(name)

    return {"__setattr__": change, "__delattr__": delete}


def _representation(names: Sequence[str]) -> Callable[[object], str]:
    @recursive_repr()
    def show(self: object) -> str:
        shown = ", ".join([f"{name}={getattr(self, name)!r}" for name in names])
        return f"{type(self).__qualname__}({shown})"

    return show


def _comparison(fields: Sequence[dataclasses.Field[Any]]) -> dict[str, Any]:
    """Return the methods for equality and hash, by the fields that take part."""
    compared = _all_of([field.name for field in fields if field.compare])
    hashed = _all_of(
        [field.name for field in fields if (field.compare if field.hash is None else field.hash)]
    )

    def equals(self: object, other: object) -> Any:
        if type(other) is not type(self):
            return NotImplemented
        return compared(self) == compared(other)

    def hash_of(self: object) -> int:
        return hash(hashed(self))

    return {"__eq__": equals, "__hash__": hash_of}


def _all_of(names: Sequence[str]) -> Callable[[object], tuple[object, ...]]:
    """Return a function that returns the attributes of these names as a tuple."""
    if len(names) > 1:
        return operator.attrgetter(*names)
    return lambda value: tuple([getattr(value, name) for name in names])


def _pickling(names: Sequence[str]) -> dict[str, Any]:
    """Return the pickle methods of a class with slots: the state is the field values in order."""

    def state(self: object) -> list[object]:
        return [getattr(self, name) for name in names]

    def restore(self: object, values: Sequence[object]) -> None:
        for name, value in zip(names, values, strict=True):
            object.__setattr__(self, name, value)

    return {"__getstate__": state, "__setstate__": restore}
