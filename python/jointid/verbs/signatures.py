"""Signatures and docstrings of verbs with the options of all subjects."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping
from typing import Any, TypeVar

from jointid.base.options import Option, documented, options_of

Verb = TypeVar("Verb", bound=Callable[..., Any])


def shows(
    function: Callable[..., Any], /, *, others: Mapping[str, object], **records: type
) -> Callable[[Verb], Verb]:
    """Decorate a verb: its signature gets the keywords of all subjects, its docstring the options of records.

    Parameters
    ----------
    function : callable
        Function of the verb for a joint. Its keywords come first.
    others : mapping of str to object
        Further keywords of other subjects, with their defaults.
    **records : type
        Records of options; each replaces the line ``**NAME`` in the docstring.
    """

    def decorate(verb: Verb) -> Verb:
        described: Any = verb
        signature, only = inspect.signature(verb), inspect.Parameter.KEYWORD_ONLY
        shown = {
            each.name: _plain(each)
            for each in signature.parameters.values()
            if each.kind != each.VAR_KEYWORD
        }
        for each in inspect.signature(function).parameters.values():
            if each.kind == only:
                shown.setdefault(each.name, each)
        said: list[Option] = []
        further = dict(others)
        for name, record in records.items():
            entries = {key: each for key, each in options_of(record).items() if each not in said}
            said += entries.values()
            further |= {key: each.default for key, each in entries.items()}
            lead = "" if name == "options" else f"{name.capitalize()}: "
            described.__doc__ = documented(described.__doc__, entries, f"**{name}", lead)
        for name, default in further.items():
            shown.setdefault(name, inspect.Parameter(name, only, default=default))
        described.__signature__ = signature.replace(parameters=[*shown.values()])
        return verb

    return decorate


def _plain(parameter: inspect.Parameter) -> inspect.Parameter:
    """Return a parameter without a meaningless annotation; the overloads have the types of each subject."""
    plain = parameter.annotation in (Any, "Any")
    return parameter.replace(annotation=parameter.empty) if plain else parameter
