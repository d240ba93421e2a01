"""The grid of a study: names and values of the swept settings, and the cells of their combinations."""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from jointid import _core
from jointid.base.advice import Action
from jointid.base.errors import InputError, shown
from jointid.joint.checks import suggestion
from jointid.joint.model import FIELDS
from jointid.simulation.scenario import Scenario
from jointid.study.cell import OPTIONS, Cell, Label


def cells_of(grid: Mapping[str, Any], scenario: Scenario | None) -> tuple[Cell, ...]:
    """Return all combinations of a grid's values. The values of the last name change fastest.

    Raises
    ------
    InputError
        A name cannot be swept, a name has no values, or a table cannot show the values.
    """
    if not isinstance(grid, Mapping):
        raise InputError(
            "a mapping from a setting's name to its values is expected", argument="grid", value=grid
        )
    known = _known(scenario)
    axes = []
    for name, values in grid.items():
        _check_name(name, known, scenario)
        axes.append([(name, label, value) for label, value in _labelled(name, values)])
    return tuple(
        Cell(labels={n: label for n, label, _ in chosen}, values={n: v for n, _, v in chosen})
        for chosen in itertools.product(*axes)
    )


def _known(scenario: Scenario | None) -> list[str]:
    names = [*OPTIONS, *(f"ga.{field}" for field in _core.GaOptions().asdict())]
    names += [f"model.{field}" for field in FIELDS]
    return names + ([] if scenario is None else scenario.options())


def _check_name(name: object, known: Sequence[str], scenario: Scenario | None) -> None:
    if not isinstance(name, str) or not name:
        raise InputError("the name of a setting is expected", argument="grid", value=name)
    part, _, inside = name.partition(".")
    free = inside and (part == "parameters" or (part in ("controller", "truth") and scenario))
    if name in known or free:
        return
    if part in ("sensors", "controller", "truth", "trajectory", "joint") and scenario is None:
        raise InputError(
            "this setting needs a simulation, but recordings are given",
            argument=name,
            place="grid",
            remedy=Action(
                "call",
                {"subject": ...},
                text="a scenario instead of recordings",
                function="sweep",
            ),
        )
    raise InputError(f"it cannot be swept; {suggestion(name, known)}", argument=name, place="grid")


def _labelled(name: str, values: Any) -> list[tuple[Label, Any]]:
    if isinstance(values, Mapping):
        pairs = [(label, value) for label, value in values.items()]
    elif isinstance(values, str | bytes) or not hasattr(values, "__iter__"):
        raise InputError("a list of values is expected", argument=name, value=values, place="grid")
    else:
        pairs = [(_label(name, value), _plain(value)) for value in values]
    if not pairs:
        raise InputError("at least one value is expected", argument=name, value=[], place="grid")
    labels = [label for label, _ in pairs]
    for label in labels:
        if not isinstance(label, str | int | float | bool | None):
            raise InputError(
                f"{shown(label)} is not a label; a text or a number is expected",
                argument=name,
                place="grid",
            )
    if len({(type(label), label) for label in labels}) < len(labels):
        raise InputError("a value is given twice", argument=name, value=labels, place="grid")
    return pairs


def _plain(value: Any) -> Any:
    return value.item() if isinstance(value, np.generic) else value


def _label(name: str, value: Any) -> Label:
    value = _plain(value)
    if value is None or isinstance(value, str | int | float | bool):
        return value
    if isinstance(value, tuple | list) and all(isinstance(v, str | int | float) for v in value):
        return ",".join(str(v) for v in value)
    raise InputError(
        f"a table cannot show the value {shown(value)}",
        argument=name,
        place="grid",
        remedy="give a mapping from labels to values",
    )
