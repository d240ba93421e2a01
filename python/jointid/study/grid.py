"""The settings that a study sweeps: their names, their values, and the cells they make."""

from __future__ import annotations

import inspect
import itertools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from jointid import _core
from jointid.base.argument_checks import require_mapping
from jointid.base.errors import InputError
from jointid.identification.prepared import prepare
from jointid.identification.search.search import Search
from jointid.joint.checks import suggestion
from jointid.joint.model import FIELDS, Model
from jointid.simulation.scenario import Scenario

# Arguments of `prepare` that a study passes on, alike for all cells or swept; and fields of the search.
OPTIONS = (
    *("method", "ga"),
    *(
        n
        for n in inspect.signature(prepare).parameters
        if n not in ("recordings", "joint", "threads")
    ),
)

Label = str | int | float | bool | None


@dataclass(frozen=True, slots=True, kw_only=True)
class Cell:
    """One combination of the swept settings.

    Attributes
    ----------
    labels : dict of str to str, int, float, bool or None
        What the table shows for each.
    values : dict of str to object
        What they are.
    """

    labels: dict[str, Label]
    values: dict[str, Any]

    def scenario(self, base: Scenario) -> Scenario:
        """The scenario with this cell's part of it."""
        return base.changed({n: v for n, v in self.values.items() if not is_option(n)})

    def options(self, common: Mapping[str, Any]) -> dict[str, Any]:
        """Arguments of `prepare`: the study's, with this cell's in their place."""
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
        """The study's search with this cell's method and settings, for one trial."""
        ga = self.values.get("ga", base.ga)
        method = self.values.get("method", base.method)
        changes = {n.removeprefix("ga."): v for n, v in self.values.items() if n.startswith("ga.")}
        found = Search(method, ga=ga, seed=seed, threads=threads)
        try:
            return replace(found, ga=found.genetic.replace(**changes))
        except (ValueError, TypeError) as error:
            raise InputError(str(error), argument="ga") from None


def _changes(parameters: object) -> dict[str, Any]:
    example = "{'coulomb': {'max': 50.0}}"
    return dict(require_mapping("parameters", {} if parameters is None else parameters, example))


def is_option(name: str) -> bool:
    """Whether a swept name is of the identification, not of the scenario."""
    return name in OPTIONS or name.startswith(("ga.", "model.", "parameters."))


def cells_of(grid: Mapping[str, Any], scenario: Scenario | None) -> tuple[Cell, ...]:
    """All combinations of a grid's values, the last name's values fastest.

    Raises
    ------
    InputError
        A name that cannot be swept, no values, or values that a table cannot show.
    """
    if not isinstance(grid, Mapping):
        raise InputError(
            f"grid is {grid!r}; a mapping from a setting's name to its values is expected"
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
        raise InputError(f"grid: {name!r} is no name of a setting")
    part, _, inside = name.partition(".")
    free = inside and (part == "parameters" or (part in ("controller", "truth") and scenario))
    if name in known or free:
        return
    if part in ("sensors", "controller", "truth", "trajectory", "joint") and scenario is None:
        raise InputError(
            f"grid: '{name}' is of a simulation; give a jointid.Scenario instead of recordings"
        )
    raise InputError(f"grid: '{name}' cannot be swept; {suggestion(name, known)}")


def _labelled(name: str, values: Any) -> list[tuple[Label, Any]]:
    if isinstance(values, Mapping):
        pairs = [(label, value) for label, value in values.items()]
    elif isinstance(values, str | bytes) or not hasattr(values, "__iter__"):
        raise InputError(f"grid: '{name}' is {values!r}; a list of values is expected")
    else:
        pairs = [(_label(name, value), _plain(value)) for value in values]
    if not pairs:
        raise InputError(f"grid: '{name}' has no values; give at least one")
    labels = [label for label, _ in pairs]
    for label in labels:
        if not isinstance(label, str | int | float | bool | None):
            raise InputError(
                f"grid: '{name}' has the label {label!r}; a text or a number is expected"
            )
    if len({(type(label), label) for label in labels}) < len(labels):
        raise InputError(f"grid: '{name}' has a value twice: {', '.join(map(str, labels))}")
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
        f"grid: '{name}' has the value {value!r}, which a table cannot show; give "
        f"{{'{name}': {{'a label': value, ...}}}}"
    )
