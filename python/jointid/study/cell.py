"""One cell of a study: a combination of the swept settings, and the arguments that it changes."""

from __future__ import annotations

import numbers
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

from jointid import _core
from jointid.base.errors import InputError
from jointid.base.options import options_of
from jointid.identification.search.search import Search
from jointid.joint.checks import check_flag, check_mapping, finite_number, is_number
from jointid.joint.model import Model
from jointid.problem.settings import ProblemOptions
from jointid.simulation.scenario import Scenario

OPTIONS = ("method", "ga", *options_of(ProblemOptions))
"""Search fields and options that a study passes on, the same for all cells or swept."""

_TOO_LARGE = 2**31  # limit of the core's integers

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
        """Return the scenario with the settings of this cell."""
        return base.changed({n: v for n, v in self.values.items() if not is_option(n)})

    def options(self, common: Mapping[str, Any]) -> dict[str, Any]:
        """Return the options of a problem: the study's, overridden by this cell's."""
        chosen = dict(common)
        fixed: dict[str, Any] = _changes(common.get("parameters"))
        model = Model.of(self.values.get("model")).over(Model.of(common.get("model")))
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
            The search refuses a value.
        """
        ga = self.values.get("ga", base.ga)
        method = self.values.get("method", base.method)
        search = Search(method, ga=ga, seed=seed, threads=threads)
        changes = {n.removeprefix("ga."): v for n, v in self.values.items() if n.startswith("ga.")}
        if not changes:
            return search
        return replace(search, ga=_with_settings(search.genetic, changes))


def _with_settings(options: _core.GaOptions, changes: Mapping[str, Any]) -> _core.GaOptions:
    """Return settings of the genetic algorithm with some of them changed."""
    present = options.asdict()
    for name, value in changes.items():
        _check_setting(f"ga.{name}", value, present[name])
    try:
        return options.replace(**changes)
    except InputError as error:
        raise InputError(
            error.reason,
            argument=error.argument.replace("GaOptions.", "ga."),
            value=error.value,
            place="grid",
        ) from None


def _check_setting(name: str, value: object, present: object) -> None:
    """Refuse a value with a type other than the present value's."""
    if isinstance(present, bool):
        check_flag("grid", name, value)
    elif isinstance(present, str):
        if not isinstance(value, str):
            raise InputError("text is expected", argument=name, value=value, place="grid")
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
