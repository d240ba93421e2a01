"""A model to be compared: its name, and what is switched on beside it."""

from __future__ import annotations

import inspect
import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

from jointid import _core
from jointid.base.errors import InputError, shown
from jointid.identification.identification import identify

# What a comparison sets for all models alike, or what steers a run: no part of a model.
_NOT_A_MODEL = {
    *("recordings", "joint", "model", "parameters", "method", "ga", "residual", "windows"),
    *("torque_hold", "mask_standstill", "seed", "threads", "callback", "checkpoint", "resume"),
}


@dataclass(frozen=True, slots=True, init=False, repr=False)
class ModelSpec:
    """A friction model by name, with the options of `identify` that extend it.

    Its text, `coulomb_viscous:asymmetric` or `stribeck:ripple=2,4`, is also understood by
    `compare_models` and the command line.

    Parameters
    ----------
    name : str
        Name of the friction model.
    **options
        Keyword arguments of `identify`, e.g. ``asymmetric=True``, ``ripple=(2,)``.
    """

    name: str
    options: tuple[tuple[str, Any], ...]

    def __init__(self, name: str, **options: Any) -> None:
        if not isinstance(name, str) or not name:
            raise InputError(f"a model's name is expected, got {name!r}")
        frozen = {key: _frozen(value) for key, value in options.items()}
        object.__setattr__(self, "name", name)
        object.__setattr__(self, "options", tuple(sorted(frozen.items())))

    def __str__(self) -> str:
        parts = [self.name]
        for key, value in self.options:
            parts.append(key if value is True else f"{key}={_written(value)}")
        return ":".join(parts)

    def __repr__(self) -> str:
        options = "".join(f", {key}={value!r}" for key, value in self.options)
        return f"ModelSpec({self.name!r}{options})"

    @classmethod
    def parse(cls, text: str) -> ModelSpec:
        """A model from its text.

        Raises
        ------
        InputError
            A part of the text says nothing.
        """
        name, *parts = text.split(":")
        options: dict[str, Any] = {}
        for part in parts:
            key, separator, value = part.partition("=")
            if not key.isidentifier() or (separator and not value) or key in options:
                raise InputError(
                    f"model '{text}': '{part}' is no option; write name:option or name:option=value, each once"
                )
            options[key] = _read(value) if separator else True
        return cls(name, **options)

    def arguments(self) -> dict[str, Any]:
        """The keyword arguments of `identify` that stand for this model.

        Raises
        ------
        InputError
            A name or an option that `identify` does not know.
        """
        if self.name not in _core.model_names():
            names = ", ".join(_core.model_names())
            raise InputError(f"model '{self.name}' is not known; known are {names}")
        known = model_options()
        arguments: dict[str, Any] = {"model": self.name}
        for key, value in self.options:
            if key not in known:
                told = ", ".join(known) or "none"
                raise InputError(f"model '{self}': option '{key}' is not known; known are {told}")
            alone = "Collection" in known[key] and not isinstance(value, tuple | bool | None)
            arguments[key] = (value,) if alone else value
        return arguments


def model_options() -> dict[str, str]:
    """The options of `identify` that are part of a model, with their types as text."""
    found = inspect.signature(identify).parameters
    return {
        name: str(entry.annotation) for name, entry in found.items() if name not in _NOT_A_MODEL
    }


def specified(models: str | ModelSpec | Sequence[Any]) -> tuple[ModelSpec, ...]:
    """The models of a call: names, texts, (name, {options}) pairs or specifications.

    Raises
    ------
    InputError
        None, something else, or the same model twice.
    """
    if not isinstance(models, str | ModelSpec | Iterable):
        raise InputError(f"models is {shown(models)}; a list of models' names is expected")
    entries = (models,) if isinstance(models, str | ModelSpec) else tuple(models)
    specs = tuple(_specified(entry) for entry in entries)
    if not specs:
        raise InputError("models is empty; give at least one, e.g. 'coulomb_viscous'")
    for index, spec in enumerate(specs):
        spec.arguments()
        if spec in specs[:index]:
            raise InputError(f"models holds '{spec}' twice")
    return specs


def _specified(entry: Any) -> ModelSpec:
    if isinstance(entry, ModelSpec):
        return entry
    if isinstance(entry, str):
        return ModelSpec.parse(entry)
    try:
        name, options = entry
        return ModelSpec(name, **options)
    except (TypeError, ValueError) as error:
        if isinstance(error, InputError):
            raise
        raise InputError(
            f"models holds {entry!r}; a name, a pair (name, {{option: value}}) or a ModelSpec is expected"
        ) from None


def _frozen(value: Any) -> Any:
    """A list as a tuple; one that holds a single value as that value, as its text reads back."""
    if isinstance(value, list | tuple | set | frozenset):
        entries = tuple(sorted(value) if isinstance(value, set | frozenset) else value)
        return entries[0] if len(entries) == 1 else entries
    return value


def _written(value: Any) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    return ",".join(map(str, value)) if isinstance(value, tuple) else str(value)


def _read(text: str) -> Any:
    words = {"true": True, "false": False}
    if text in words:
        return words[text]
    if "," in text:
        return tuple(_read(part) for part in text.split(",") if part)
    try:
        return int(text)
    except ValueError:
        pass
    try:
        return float(text) if math.isfinite(float(text)) else text
    except ValueError:
        return text
