"""Errors and advice in the words of the page: its fields, and the user's name of the log."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path

from jointid.base.advice import Action
from jointid.base.error_text import on_one_line
from jointid.base.errors import NOT_GIVEN, InputError

FIELDS = {
    "gear_ratio": "gear ratio",
    "torque_constant": "torque constant",
    "inertia": "drive's inertia at the output",
    "sample_period": "time between rows",
    "model": "friction model",
}
"""Field on the page for each argument of `load`, `Joint` or `identify`."""


def worded(error: InputError, file: Path | None = None, name: str = "") -> str:
    """Return an error in one sentence.

    Parameters
    ----------
    error : InputError
    file : Path, optional
        Path of the log on this machine. Default: none.
    name : str
        The user's name of the log.

    Examples
    --------
    >>> error = InputError("more than 0 is expected", argument="torque_constant", value=-1.0, place="joint")
    >>> worded(error)
    'torque constant is -1: more than 0 is expected'
    """
    place = "" if error.place.startswith("joint") else error.place  # there is only one joint
    field = field_of(error.argument)
    if field and error.value not in (NOT_GIVEN, None) and isinstance(error.value, int | float):
        field = f"{field} is {error.value:g}"
    sentence = ": ".join(filter(None, (place, field, error.reason)))
    remedies = " or ".join(
        each if isinstance(each, str) else of_action(each) for each in error.remedy
    )
    text = on_one_line(f"{sentence}; {remedies}" if remedies else sentence)
    return text if file is None else text.replace(str(file), name or file.name)


def field_of(argument: str) -> str:
    """Return the field of the page for an argument's name.

    Examples
    --------
    >>> field_of("side.velocity"), field_of("gear_ratio"), field_of("time")
    ('side of velocity', 'gear ratio', 'time')
    """
    head, _, signal = argument.partition(".")
    if head in _SIGNALS and signal:
        return f"{_SIGNALS[head]} of {signal_text(signal)}"
    return FIELDS.get(argument, argument.replace("_", " "))


def of_action(action: Action) -> str:
    """Return the advice as part of a sentence.

    Examples
    --------
    >>> of_action(Action("call", {"units": {"position": "deg"}}, function="load"))
    'choose the unit deg for position'
    >>> of_action(Action("call", {"gear_ratio": ..., "torque_constant": 0.1}, function="Joint"))
    'fill in gear ratio, fill in 0.1 for torque constant'
    """
    if action.kind != "call":
        return f"{action.kind} {action.text}".strip()
    steps = [
        step
        for name, value in action.arguments.items()
        for step in _CHOSEN.get(name, _filled)(name, value)
    ]
    purpose = f" ({action.text})" if action.text else ""
    return ", ".join(steps) + purpose


def label_of(action: Action) -> str:
    """Return the label of a button for an action.

    Examples
    --------
    >>> label_of(Action("call", {"model": "stribeck"}))
    'Choose the friction model stribeck'
    """
    text = of_action(action)
    return text[:1].upper() + text[1:]


def signal_text(signal: str) -> str:
    """Return a signal's name in words."""
    return signal.replace("_", " ")


def unit_text(name: str) -> str:
    """Return a unit in the usual notation.

    Examples
    --------
    >>> unit_text("rad_s"), unit_text("mNm")
    ('rad/s', 'mN·m')
    """
    return name.replace("_", "/").replace("Nm", "N·m")


def _of_signals(name: str, value: object) -> list[str]:
    """Return the choices for each signal of a mapping."""
    found = []
    noun = _SIGNALS[name]
    for signal, chosen in value.items() if isinstance(value, Mapping) else ():
        if chosen is None:
            found.append(f"choose no {noun} for {signal_text(signal)}")
        elif chosen is ...:
            found.append(f"choose the {noun} of {signal_text(signal)}")
        else:
            text = unit_text(str(chosen)) if name == "units" else _shown(chosen)
            found.append(f"choose the {noun} {text} for {signal_text(signal)}")
    return found


def _of_model(name: str, value: object) -> list[str]:
    return [f"choose the {FIELDS[name]} {_shown(value)}"]


def _filled(name: str, value: object) -> list[str]:
    """Return the fields to fill in. An argument without a field appears by its name in words."""
    field = field_of(name)
    if isinstance(value, Mapping):
        inside = ", ".join(f"{key} = {_shown(each)}" for key, each in value.items())
        return [f"{field}: {inside or 'none'}"]
    if value is ... or value == "...":
        return [f"fill in {field}"]
    if name in FIELDS:
        return [f"fill in {_shown(value)} for {field}"]
    return [f"{field}: {_shown(value)}"]


def _shown(value: object) -> str:
    if value is None:
        return "none"
    if isinstance(value, bool):
        return "yes" if value else "no"
    return f"{value:.4g}" if isinstance(value, float) else str(value)


_SIGNALS = {"columns": "column", "units": "unit", "scale": "scale", "side": "side"}
_CHOSEN: dict[str, Callable[[str, object], list[str]]] = {
    **dict.fromkeys(_SIGNALS, _of_signals),
    "model": _of_model,
}
