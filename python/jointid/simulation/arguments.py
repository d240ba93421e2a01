"""Checks of a simulation's arguments. Single values are repeated to one list length."""

from collections.abc import Callable, Iterable, Mapping
from typing import Any, get_args

import numpy as np

from jointid import _core
from jointid.base.errors import InputError
from jointid.joint.checks import finite_number
from jointid.joint.joint import Joint

Controller = (
    _core.OpenLoop
    | _core.Pd
    | _core.Pid
    | _core.CompensatedPid
    | _core.AdaptiveRobust
    | _core.LugreObserver
)

LAWS: Mapping[str, Callable[..., Controller]] = {
    "adaptive_robust": _core.AdaptiveRobust,
    "compensated_pid": _core.CompensatedPid,
    "lugre_observer": _core.LugreObserver,
    "pid": _core.Pid,
    "pd": _core.Pd,
    "open_loop": _core.OpenLoop,
}
"""Controllers by the name that files and the command line use."""


def law_name(controller: Controller) -> str:
    """Return the name that files and the command line use for a controller."""
    return next(name for name, law in LAWS.items() if type(controller) is law)


def side_by_side(
    joints: Any, controllers: Any, seeds: Any
) -> tuple[list[Joint], list[Controller], list[int]]:
    """Return lists of one length; a single value is used for all."""
    given = {"joints": joints, "controllers": controllers, "seeds": seeds}
    known: dict[str, tuple[type, ...]] = {
        "joints": (Joint,),
        "controllers": get_args(Controller),
        "seeds": (int, np.integer),
    }
    lists = {}
    for what, value in given.items():
        several = isinstance(value, Iterable) and not isinstance(value, str)
        lists[what] = list(value) if several else [value]
        for entry in lists[what]:
            if not isinstance(entry, known[what]) or isinstance(entry, bool):
                names = ", ".join(kind.__name__ for kind in known[what])
                expected = {"joints": "a Joint", "seeds": "a whole number"}.get(
                    what, f"one of {names}"
                )
                raise InputError(f"{expected} is expected", argument=what, value=entry)
    count = max(len(entries) for entries in lists.values())
    for what, entries in lists.items():
        if len(entries) not in (1, count) or not entries:
            raise InputError(
                f"this argument has {len(entries)} entries, but others have {count}",
                argument=what,
                remedy="give one entry for all, or the same number of entries",
            )
        lists[what] = entries if len(entries) == count else entries * count
    for seed in lists["seeds"]:
        if not 0 <= seed < 2**64:
            raise InputError(
                "a whole number from 0 to 2**64 - 1 is expected", argument="seed", value=int(seed)
            )
    return lists["joints"], lists["controllers"], [int(seed) for seed in lists["seeds"]]


def finite(what: str, value: Any) -> float:
    """Return an argument as a float, or raise an error."""
    return finite_number("", what, value)


def positive(what: str, value: Any) -> float:
    """Return an argument above 0 as a float, or raise an error."""
    number = finite(what, value)
    if number <= 0.0:
        raise InputError("more than 0 is expected", argument=what, value=number)
    return number


def whole_multiple(what: str, value: Any, period: float) -> int:
    """Return the number of control periods in an argument, or raise an error."""
    ratio = positive(what, value) / period
    if round(ratio) < 1 or abs(ratio - round(ratio)) > 1e-6 * ratio:
        raise InputError(
            f"a whole number of control periods ({period!r} s) is expected",
            argument=what,
            value=float(value),
        )
    return round(ratio)
