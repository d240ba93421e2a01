"""First look at a file: its columns, and the signals that they probably are."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field
from pathlib import Path
from typing import Any

import numpy as np

from jointid.base.advice import Action
from jointid.base.errors import InputError
from jointid.base.values import dataclass
from jointid.recording.columns import Column
from jointid.recording.headers import understood
from jointid.recording.matching import match_columns
from jointid.recording.readers.loading import table_of
from jointid.recording.table import Table

_TRIES = 4  # consecutive proposals: time and position, then a torque, then units


@dataclass(frozen=True, slots=True, kw_only=True)
class LookedColumn:
    """A column of a table.

    Attributes
    ----------
    header : str
    unit : str
        Unit from the header, by its name in `load`; "" if the header states none.
    low, high : float or None
        Smallest and largest finite value, in the file's unit; None if the cells are not numbers.
    """

    header: str
    unit: str
    low: float | None
    high: float | None


@dataclass(frozen=True, slots=True, kw_only=True)
class FirstLook:
    """A table and the probable meaning of its columns.

    Attributes
    ----------
    columns : tuple of LookedColumn
    signals : mapping of str to int
        Signal → number of its column, from clear headers or from likely words in them.
    units : mapping of str to str
        Signal → proposed unit, if the header states none.
    side : mapping of str to str
        Signal → proposed side of the gear, if its header names the motor.
    certain : bool
        Whether the headers alone are enough to read the file.
    problem : str
        Reason why no proposal was possible; otherwise "".
    """

    columns: tuple[LookedColumn, ...]
    signals: Mapping[str, int]
    units: Mapping[str, str] = field(default_factory=dict)
    side: Mapping[str, str] = field(default_factory=dict)
    certain: bool = True
    problem: str = ""


def first_look(path: Path) -> FirstLook:
    """Return the columns of a file of one joint and their probable signals.

    Raises
    ------
    InputError
        The file cannot be read as a table.
    """
    table = table_of(path)
    arguments: dict[str, dict[str, Any]] = {}
    found: Mapping[str, Column] = {}
    problem, certain = "", True
    for _ in range(_TRIES):
        try:
            found = match_columns(
                table,
                columns=arguments.get("columns"),
                units=arguments.get("units"),
                scale=arguments.get("scale"),
                kind=None,
            ).found
        except InputError as error:
            certain, problem = False, str(error.reason)
            if not _take(error, arguments):
                break
        else:
            problem = ""
            break
    return FirstLook(
        columns=tuple(_looked(table, k) for k in range(len(table.headers))),
        signals={signal: column.index for signal, column in found.items()}
        or _proposed(table, arguments),
        units={str(k): str(v) for k, v in arguments.get("units", {}).items()},
        side={str(k): str(v) for k, v in arguments.get("side", {}).items()},
        certain=certain,
        problem=problem,
    )


def _take(error: InputError, arguments: dict[str, dict[str, Any]]) -> bool:
    """Add the error's proposal to the arguments; return whether it is new."""
    for action in error.remedy:
        if not isinstance(action, Action) or action.kind != "call" or action.function != "load":
            continue
        new = False
        for name, mapping in action.arguments.items():
            if isinstance(mapping, Mapping) and name in ("columns", "units", "scale", "side"):
                known = arguments.setdefault(name, {})
                new = new or any(known.get(key, ...) != value for key, value in mapping.items())
                known.update(mapping)
        if new:
            return True
    return False


def _proposed(table: Table, arguments: Mapping[str, Mapping[str, Any]]) -> dict[str, int]:
    """Return signal → number of the proposed column."""
    found = {}
    for signal, column in arguments.get("columns", {}).items():
        if isinstance(column, int):
            found[signal] = column
        elif column in table.headers:
            found[signal] = table.headers.index(column)
    return found


def _looked(table: Table, index: int) -> LookedColumn:
    header = table.headers[index]
    unit = understood(header).unit
    low = high = None
    try:
        (values,) = table.numbers([index])
    except InputError:
        pass
    else:
        finite = values[np.isfinite(values)]
        if len(finite):
            low, high = float(finite.min()), float(finite.max())
    return LookedColumn(header=header, unit="" if unit is None else unit.name, low=low, high=high)
