"""Complete advice for an error: its own, and that of the errors which would follow."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from jointid.base.advice import Action
from jointid.base.errors import InputError

_STEPS = 4  # number of further errors to look for
_MERGED = ("columns", "units", "scale", "side", "where")
_USUAL = {
    "gear_ratio": 1.0,
    "sample_period": 0.001,
}  # trial values in place of those that only the user knows
_OF_SEVERAL = "load_robot"
_READING = ("load", "Joint")  # both are options of a command


def looked_ahead(
    error: InputError,
    attempt: Callable[[Mapping[str, Any]], object],
    torque_column: Callable[[Mapping[str, Any]], Action | None],
) -> InputError:
    """Return an error with advice that leads to a usable recording, as far as the program can see.

    Each advice is applied and the file is read again. A user with a foreign log gets all that is missing in one line,
    not in several attempts.

    Parameters
    ----------
    error : InputError
        Error of the first attempt to read the file.
    attempt : callable
        Function that reads again with additional arguments of `load`, and raises the next error.
    torque_column : callable
        Function that returns the call with a column that may be the torque; None without such a column.

    Returns
    -------
    InputError
        The same error if nothing more is missing.
    """
    found = [(error, _call(error, torque_column, {}))]
    while found[-1][1] is not None and len(found) <= _STEPS:
        advised = _merged([action for _, action in found if action is not None])
        filled = _filled(advised)
        if filled is None:
            break
        try:
            attempt(filled)
        except InputError as following:
            action = _call(following, torque_column, filled)
            if action is None or _merged([Action("call", advised), action]) == advised:
                break
            found.append((following, action))
        else:
            break
    actions = [action for _, action in found if action is not None]
    if not actions or (len(actions) == 1 and error.remedy and actions[0] is error.remedy[0]):
        return error
    merged = _merged(actions)
    purposes = "; ".join(dict.fromkeys(action.text for action in actions if action.text))
    said: dict[str, str] = {}  # the first reason for an argument is enough
    for each, _ in found:
        said.setdefault(each.argument or each.reason, _reason(each, first=each is error))
    return InputError(
        "; ".join(said.values()),
        argument=error.argument,
        value=error.value,
        place=error.place,
        remedy=(Action("call", merged, purposes, "load"), *_of_all_joints(error, merged)),
    )


def _reason(error: InputError, *, first: bool) -> str:
    return error.reason if first or not error.argument else f"{error.argument}: {error.reason}"


def _call(
    error: InputError,
    torque_column: Callable[[Mapping[str, Any]], Action | None],
    given: Mapping[str, Any],
) -> Action | None:
    """Return the first advice of an error if it is about reading."""
    first = error.remedy[0] if error.remedy else None
    if not isinstance(first, Action) or first.kind != "call" or first.function not in _READING:
        return None
    if first.arguments == {"columns": {"torque": ...}}:
        return torque_column(given) or first
    return first


def _merged(actions: list[Action]) -> dict[str, Any]:
    merged: dict[str, Any] = {}
    for action in actions:
        for name, value in action.arguments.items():
            known = merged.get(name) if name in _MERGED else None
            merged[name] = {**known, **value} if known else value
    return merged


def _filled(advised: Mapping[str, Any]) -> dict[str, Any] | None:
    """Return arguments that can be tried; None if only the user knows one of them."""
    filled = {
        name: _USUAL.get(name, value) if value is ... else value for name, value in advised.items()
    }
    unknown = [value for value in filled.values() if value is ...]
    inner = [
        each for value in filled.values() if isinstance(value, Mapping) for each in value.values()
    ]
    return None if unknown or ... in inner else filled


def _of_all_joints(error: InputError, merged: Mapping[str, Any]) -> tuple[str | Action, ...]:
    """Return the other advice for a file with several joints: all of them, with separate gear ratios if needed."""
    ratio = {name: merged[name] for name in ("gear_ratio",) if name in merged}
    own = "; one ratio for each joint, separated by commas" * bool(ratio)
    return tuple(
        Action("call", {**each.arguments, **ratio}, f"{each.text}{own}", each.function)
        for each in error.remedy[1:]
        if isinstance(each, Action) and each.function == _OF_SEVERAL
    )
