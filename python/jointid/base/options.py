"""Keyword options of functions, declared once: default, check, help, and the name on the command line.

A `TypedDict` lists the options, each as ``Annotated[TYPE, Option(...)]``. A function takes them as
``**options: Unpack[THAT]``, which type checkers expand; `takes` adds them to the signature at run time.
"""

import functools
import inspect
from collections.abc import Callable, Mapping
from typing import Any, TypeVar

from jointid.base.values import dataclass

_WIDTH = 100  # width of docstring lines

Taker = TypeVar("Taker", bound=Callable[..., Any])


@dataclass(frozen=True, slots=True, kw_only=True)
class Option:
    """One keyword of a function, with all its descriptions.

    Attributes
    ----------
    kind : str
        Type as worded in the reference.
    help : str
        Meaning, for the reference.
    default : object
    checked : callable
        Takes name and value; returns the checked value or raises an `InputError`. Default: no check.
    flag : str
        Name on the command line; empty: not on the command line.
    phrase : str
        Help text on the command line.
    form : str
        Form of the value on the command line: "text", "number", "windows", "numbers by name" or "texts by name".
    metavar : str, optional
        Placeholder of the value on the command line. Default: the name.
    """

    kind: str
    help: str
    default: object = None
    checked: Callable[[str, Any], Any] = lambda _, value: value
    flag: str = ""
    phrase: str = ""
    form: str = "text"
    metavar: str | None = None


def options_of(options: type) -> dict[str, Option]:
    """Return the options of a `TypedDict`, by name."""
    return {name: hint.__metadata__[0] for name, hint in options.__annotations__.items()}


def checked(options: type, stated: Mapping[str, Any]) -> dict[str, Any]:
    """Return all options of a `TypedDict` as checked values, stated or by default.

    Raises
    ------
    InputError
        A value cannot be used.
    """
    return {
        name: option.checked(name, stated.get(name, option.default))
        for name, option in options_of(options).items()
    }


def takes(options: type) -> Callable[[Taker], Taker]:
    """Decorate a function with ``**options``: signature and docstring list them, and calls get values or defaults."""
    entries = options_of(options)
    defaults = {name: option.default for name, option in entries.items()}

    def decorate(taker: Taker) -> Taker:
        if isinstance(taker, type):
            setattr(taker, "__init__", decorate(vars(taker)["__init__"]))  # noqa: B010 (of a class, to the type checker)
            taker.__doc__ = documented(taker.__doc__, entries)
            return taker
        signature = inspect.signature(taker)
        own = [each for each in signature.parameters.values() if each.kind != each.VAR_KEYWORD]
        known = {each.name for each in own} | entries.keys()

        @functools.wraps(taker)
        def call(*unnamed: Any, **named: Any) -> Any:
            for name in named:
                if name not in known:
                    raise TypeError(
                        f"{taker.__qualname__}() got an unexpected keyword argument {name!r}"
                    )
            return taker(*unnamed, **(defaults | named))

        shown = [
            inspect.Parameter(
                name,
                inspect.Parameter.KEYWORD_ONLY,
                default=option.default,
                annotation=options.__annotations__[name].__origin__,
            )
            for name, option in entries.items()
        ]
        described: Any = call
        described.__signature__ = signature.replace(parameters=[*own, *shown])
        described.__doc__ = documented(taker.__doc__, entries)
        return described  # type: ignore[no-any-return]

    return decorate


def documented(
    text: str | None, entries: Mapping[str, Option], line: str = "**options", lead: str = ""
) -> str | None:
    """Return a docstring with the options instead of its line ``**options``; `lead` begins each description."""
    before, mark, behind = (text or "").partition(f"{line}\n")
    if not mark:
        return text
    indent = before[before.rfind("\n") + 1 :]
    lines = []
    for name, option in entries.items():
        lines += [f"{name} : {option.kind}", *_wrapped(lead + option.help, f"{indent}    ")]
    return f"{before}{f'{chr(10)}{indent}'.join(lines)}\n{behind}"


def _wrapped(text: str, indent: str) -> list[str]:
    """Return a paragraph as lines; `textwrap` is slow to import."""
    lines = [""]
    for word in text.split():
        if lines[-1] and len(indent) + len(lines[-1]) + len(word) >= _WIDTH:
            lines.append("")
        lines[-1] = f"{lines[-1]} {word}" if lines[-1] else f"    {word}"
    return lines
