"""The grid of a study: names and values of the swept settings, and the cells of their combinations."""

from __future__ import annotations

import inspect
import itertools
import numbers
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from jointid import _core
from jointid.base.errors import InputError, shown
from jointid.identification.prepared import prepare
from jointid.identification.search.search import Search
from jointid.joint.checks import check_flag, check_mapping, finite_number, is_number, suggestion
from jointid.joint.model import FIELDS, Model
from jointid.simulation.scenario import Scenario

# Fields of the search, and arguments of `prepare` that a study passes on: the same for all cells, or swept.
OPTIONS = (
    *("method", "ga"),
    *(
        n
        for n in inspect.signature(prepare).parameters
        if n not in ("recordings", "joint", "threads")
    ),
)

_TOO_LARGE = 2**31  # for a whole number of the core

Label = str | int | float | bool | None


@dataclass(frozen=True, slots=True, kw_only=True)
class Cell:
    """One combination of the swept settings.

    Attributes
    ----------
    labels : dict of str to str, int, float, bool or None
        The label of each value, for tables.
    values : dict of str to object
        The values.
    """

    labels: dict[str, Label]
    values: dict[str, Any]

    def scenario(self, base: Scenario) -> Scenario:
        """Return the scenario with this cell's settings of it."""
        return base.changed({n: v for n, v in self.values.items() if not is_option(n)})

    def options(self, common: Mapping[str, Any]) -> dict[str, Any]:
        """Return arguments of `prepare`: the study's, overridden by this cell's."""
        chosen = dict(common)
        fixed: dict[str, Any] = _changes(common.get("parameters"))
        model = Model.of(self.values.get("model", common.get("model")))
        for name, value in self.values.items():
            part, _, inside = name.partition(".")
            if part == "parameters" and inside:
                fixed[inside] = value
            elif part == "model" and inside:
                model = model.replace(**{inside: value})
            elif name == "parameters":
                fixed |= _changes(value)
            elif name in OPTIONS and name not in ("ga", "method", "model"):
                chosen[name] = value
        return chosen | {"model": model} | ({"parameters": fixed} if fixed else {})

    def search(self, base: Search, seed: int, threads: int) -> Search:
        """Return the study's search with this cell's method and settings, for one trial.

        Raises
        ------
        InputError
            A value that the search refuses.
        """
        ga = self.values.get("ga", base.ga)
        method = self.values.get("method", base.method)
        search = Search(method, ga=ga, seed=seed, threads=threads)
        changes = {n.removeprefix("ga."): v for n, v in self.values.items() if n.startswith("ga.")}
        return replace(search, ga=_with_settings(search.genetic, changes))


def _with_settings(options: _core.GaOptions, changes: Mapping[str, Any]) -> _core.GaOptions:
    """Return settings of the genetic algorithm with some of them changed."""
    present = options.asdict()
    for name, value in changes.items():
        _check_setting(f"ga.{name}", value, present[name])
    try:
        return options.replace(**changes)
    except InputError as error:
        raise error.at("grid") from None


def _check_setting(name: str, value: object, present: object) -> None:
    """Refuse a value whose kind is not that of the present value."""
    if isinstance(present, bool):
        check_flag("grid", name, value)
    elif isinstance(present, str):
        if not isinstance(value, str):
            raise InputError("a text is expected", argument=name, value=value, place="grid")
    elif not isinstance(present, int):
        finite_number("grid", name, value)
    elif not (
        is_number(value) and isinstance(value, numbers.Integral) and abs(int(value)) < _TOO_LARGE
    ):
        raise InputError(
            f"a whole number below {_TOO_LARGE} is expected",
            argument=name,
            value=value,
            place="grid",
        )


def _changes(parameters: Any) -> dict[str, Any]:
    if parameters is None:
        return {}
    check_mapping("", "parameters", parameters)
    return dict(parameters)


def is_option(name: str) -> bool:
    """Return whether a swept name belongs to the identification, not to the scenario."""
    return name in OPTIONS or name.startswith(("ga.", "model.", "parameters."))


def cells_of(grid: Mapping[str, Any], scenario: Scenario | None) -> tuple[Cell, ...]:
    """Return all combinations of a grid's values; those of the last name change fastest.

    Raises
    ------
    InputError
        A name that cannot be swept, no values, or values that a table cannot show.
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
            "it is a setting of a simulation, and recordings are given",
            argument=name,
            place="grid",
            remedy="give a scenario instead of recordings",
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
                f"{shown(label)} is no label; a text or a number is expected",
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
        f"it has the value {shown(value)}, which a table cannot show",
        argument=name,
        place="grid",
        remedy="give a mapping from labels to values",
    )
