"""The only exception for bad input, as data that each interface words."""

from __future__ import annotations

import pickle
from pathlib import PurePath
from typing import Any

from jointid.base.advice import Action
from jointid.base.error_text import on_one_line


class _NotGiven:
    """Marker for "no value", because None may be a value."""

    def __repr__(self) -> str:
        return "NOT_GIVEN"

    def __reduce__(self) -> str:
        return "NOT_GIVEN"

    def __bool__(self) -> bool:
        return False


NOT_GIVEN: Any = _NotGiven()


class InputError(ValueError):
    """Error for input that cannot be used: reason, place and remedy.

    Parameters
    ----------
    reason : str
        Reason why the input cannot be used, or the expected input. The phrase fits a function call and a command
        line.
    argument : str
        Name of the argument, field, key or column. Default: no name.
    value : object
        The value that cannot be used. Default: not shown.
    place : str
        File, row or table of the value. Default: the call.
    remedy : str, Action or tuple of these
        Remedy, if the reason does not state it. Default: none.

    Attributes
    ----------
    reason, argument, value, place, remedy
        The parameters as attributes; `remedy` is always a tuple.

    Examples
    --------
    >>> str(InputError("choose one of ga, separable, random", argument="method", value="genetic"))
    "method is 'genetic': choose one of ga, separable, random"
    """

    def __init__(
        self,
        reason: str,
        *,
        argument: str = "",
        value: object = NOT_GIVEN,
        place: str = "",
        remedy: str | Action | tuple[str | Action, ...] = (),
    ) -> None:
        super().__init__(reason)
        self.reason = reason
        self.argument = argument
        self.value = value
        self.place = place
        self.remedy = remedy if isinstance(remedy, tuple) else (remedy,)

    def at(self, place: str) -> InputError:
        """Return the same error with another place before its present place.

        Parameters
        ----------
        place : str
            File, row or table. A colon separates it from the present place.
        """
        inner = f": {self.place}" if self.place else ""
        return type(self)(
            self.reason,
            argument=self.argument,
            value=self.value,
            place=f"{place}{inner}",
            remedy=self.remedy,
        )

    def __str__(self) -> str:
        """Return the sentence that Python shows."""
        place = f"{self.place}: " if self.place else ""
        subject = self.argument
        if self.value is not NOT_GIVEN:
            subject = f"{subject or 'this'} is {shown(self.value)}"
        sentence = f"{subject}: {self.reason}" if subject else self.reason
        remedies = " or ".join(str(each) for each in self.remedy)
        return on_one_line(f"{place}{sentence}" + (f"; {remedies}" if remedies else ""))

    def __repr__(self) -> str:
        """Return the fields that differ from their defaults."""
        fields = {"argument": self.argument, "place": self.place, "remedy": self.remedy}
        texts = [repr(self.reason), *(f"{name}={each!r}" for name, each in fields.items() if each)]
        if self.value is not NOT_GIVEN:
            texts.append(f"value={shown(self.value)}")
        return f"{type(self).__name__}({', '.join(texts)})"

    def __reduce__(self) -> tuple[Any, ...]:
        """Return the state for pickle; a value that cannot be pickled is replaced by its text."""
        state = dict(self.__dict__)
        try:
            pickle.dumps(self.value)
        except Exception:  # the value's own methods may raise anything
            state["value"] = shown(self.value)
        return type(self), (self.reason,), state


def shown(value: object) -> str:
    """Return a value for a message: short plain values as in Python, paths in full, other values by their type."""
    if isinstance(value, PurePath):
        return repr(str(value))
    if value is None or isinstance(value, str | bool | int | float | list | tuple | dict):
        try:
            text = repr(value)
        except (RecursionError, ValueError):  # too deep, or too many digits
            text = ""
        if text and len(text) <= 60:
            return text
    name = type(value).__name__
    return f"{'an' if name[0] in 'AEIOaeio' else 'a'} {name}"
