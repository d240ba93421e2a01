"""The column, unit and scale of each signal: from the headers, and from `columns`, `units` and `scale`."""

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from jointid.base.advice import Action
from jointid.base.argument_checks import require_mapping
from jointid.base.errors import InputError
from jointid.recording.column_lookup import column_index, listed
from jointid.recording.headers import ALIASES, parsed, plain
from jointid.recording.signals import SIGNALS, FloatArray, check_signal_name, dimensions
from jointid.recording.table import Table
from jointid.recording.units import Unit, unit_named, unit_names

# Signals whose dimension shows the kind of joint, the clearest first.
_SHOWING_KIND = ("position", "link_position", "reference", "velocity", "torque")
_LIKELY = {"time": ("time", "stamp", "clock"), "position": ("pos", "ang", "travel")}


@dataclass(frozen=True, kw_only=True)
class Column:
    """A column that holds a signal.

    Attributes
    ----------
    index : int
        0-based number of the column.
    unit : Unit or None
        None: no unit is named anywhere, SI is assumed.
    unknown : str
        Text in the unit's place of the header that is no known unit. Default: none.
    scale : float, optional
        Factor from file units to SI; replaces the unit. Default: the unit's factor.
    """

    index: int
    unit: Unit | None
    unknown: str = ""
    scale: float | None = None

    def to_si(self, values: FloatArray) -> FloatArray:
        """Return the column's values in SI units."""
        if self.scale is None:
            return self.unit.to_si(values) if self.unit else values
        with np.errstate(over="ignore", under="ignore"):  # inf is refused later, by signal
            return values * self.scale


def match_columns(
    table: Table,
    *,
    columns: Mapping[str, str | int | None] | None,
    units: Mapping[str, str] | None,
    scale: Mapping[str, float] | None,
    kind: str | None,
) -> tuple[dict[str, Column], str]:
    """Return the column of each signal present, and the kind of joint that their units show.

    Parameters
    ----------
    table : Table
    columns, units, scale, kind
        As in `load`.

    Raises
    ------
    InputError
        A signal without a column that needs one, with two, or with a unit of another dimension;
        a header, signal or unit that does not exist.
    """
    for name, mapping, example in (
        ("columns", columns, "{'position': 'enc1'}"),
        ("units", units, "{'position': 'deg'}"),
        ("scale", scale, "{'position': 0.001}"),
    ):
        if mapping is not None:
            require_mapping(name, mapping, example)
    candidates = _candidates(table, columns or {})
    for signal in ("time", "position"):
        if not candidates.get(signal):
            raise _missing(table, signal, candidates, kind)
    for signal, text in (units or {}).items():
        check_signal_name(signal, "units")
        _check_recognised(table, signal, candidates, f"units.{signal}")
        unit = unit_named(
            text,
            dimensions=dimensions(signal, kind),
            argument=f"units.{signal}",
            place=table.source,
        )
        candidates[signal] = [Column(index=c.index, unit=unit) for c in candidates[signal]]
    for signal, factor in (scale or {}).items():
        check_signal_name(signal, "scale")
        check_scale(table, signal, factor, units or {})
        _check_recognised(table, signal, candidates, f"scale.{signal}")
        candidates[signal] = [
            Column(index=c.index, unit=None, scale=float(factor)) for c in candidates[signal]
        ]
    kind = kind or _kind(table, candidates)
    return {
        signal: _only_fitting(table, signal, candidates[signal], kind)
        for signal in SIGNALS
        if candidates.get(signal)
    }, kind


def _check_recognised(
    table: Table, signal: str, candidates: Mapping[str, list[Column]], argument: str
) -> None:
    if not candidates.get(signal):
        raise InputError(
            f"no column is recognised as {signal}", argument=argument, place=table.header_place
        )


def check_scale(table: Table, signal: str, factor: object, units: Mapping[str, str]) -> None:
    """Refuse a factor that is no finite number other than 0, or beside a unit."""
    number = isinstance(factor, int | float | np.number) and not isinstance(factor, bool)
    if not number or factor == 0 or not math.isfinite(factor):  # type: ignore[arg-type]
        raise InputError(
            "a finite number other than 0 is expected, the factor from file units to SI",
            argument=f"scale.{signal}",
            value=factor,
            place=table.source,
        )
    if signal in units:
        raise InputError(
            f"{signal} also has the unit {units[signal]!r}; give one of them",
            argument=f"scale.{signal}",
            value=factor,
            place=table.source,
        )


def _candidates(table: Table, columns: Mapping[str, str | int | None]) -> dict[str, list[Column]]:
    """Return the columns that `columns` or a header assigns to each signal."""
    chosen: dict[int, str] = {}
    for signal, column in columns.items():
        check_signal_name(signal, "columns")
        if column is None:  # leave this signal out
            continue
        index = column_index(table, column, f"columns.{signal}")
        if index in chosen:
            raise InputError(
                f"this column is also {chosen[index]}; one column holds one signal",
                argument=f"columns.{signal}",
                value=column,
                place=table.header_place,
            )
        chosen[index] = signal
    candidates: dict[str, list[Column]] = {}
    for index, header in enumerate(table.headers):
        name, unit, unknown = parsed(header)
        signal_here = chosen.get(index) or ALIASES.get(name)
        if signal_here == "late" and index not in chosen and table.saved is None:
            continue  # elsewhere a column of this name may be anything
        if signal_here and (index in chosen or signal_here not in columns):
            column_here = Column(index=index, unit=unit, unknown=unknown)
            candidates.setdefault(signal_here, []).append(column_here)
    return candidates


def _kind(table: Table, candidates: Mapping[str, list[Column]]) -> str:
    for signal in _SHOWING_KIND:
        kinds = {
            kind: column
            for kind in ("revolute", "prismatic")
            for column in candidates.get(signal, [])
            if column.unit and column.unit.dimension in dimensions(signal, kind)
        }
        if len(kinds) == 2:
            first, second = (table.headers[column.index] for column in kinds.values())
            raise InputError(
                f"{first!r} and {second!r} are both recognised as {signal}, of a revolute and of a "
                "prismatic joint",
                place=table.header_place,
                remedy=tuple(_chosen(signal, column) for column in kinds.values()),
            )
        if kinds:
            return next(iter(kinds))
    return "revolute"


def _only_fitting(table: Table, signal: str, candidates: list[Column], kind: str) -> Column:
    """Return the only candidate whose unit fits the signal, or raise `InputError`."""
    fitting = [
        column
        for column in candidates
        if not column.unknown
        and (column.unit is None or column.unit.dimension in dimensions(signal, kind))
    ]
    if len(fitting) == 1:
        return fitting[0]
    if fitting:
        names = " and ".join(
            f"{table.headers[column.index]!r} (column {column.index})" for column in fitting
        )
        raise InputError(
            f"{names} are both recognised as {signal}",
            place=table.header_place,
            remedy=tuple(_chosen(signal, column) for column in fitting[:2]),
        )
    raise _wrong_unit(table, signal, candidates[0], kind)


def _wrong_unit(table: Table, signal: str, column: Column, kind: str) -> InputError:
    known = unit_names(dimensions(signal, kind))
    if column.unit is None:
        problem = f"has the unknown unit {column.unknown!r}"
    elif column.unit.dimension == "raw reading":
        problem = "is a raw reading"
    else:
        problem = f"is in {column.unit.name} ({column.unit.dimension})"
    if column.unit and column.unit.dimension in ("raw reading", "voltage"):
        remedy = Action(
            "call",
            {"scale": {signal: 1.0}},
            function="load",
            text="with the factor from file units to SI instead of 1.0",
        )
    else:
        remedy = Action(
            "call", {"units": {signal: known[0]}}, function="load", text="if this is its unit"
        )
    other: str | Action = "choose another column"
    if signal not in _LIKELY:  # it may be left out
        other = Action("call", {"columns": {signal: None}}, function="load")
    return InputError(
        f"{signal} of a {kind} joint {problem}; {' or '.join(dimensions(signal, kind))} is "
        f"expected, in {', '.join(known)}",
        place=f"{table.header_place}, column {table.headers[column.index]!r}",
        remedy=(remedy, other),
    )


def _chosen(signal: str, column: Column) -> Action:
    return Action("call", {"columns": {signal: column.index}}, function="load")


def _missing(
    table: Table, signal: str, candidates: Mapping[str, list[Column]], kind: str | None
) -> InputError:
    """Return the error for a signal without a column; its remedy is a column that may hold it."""
    owners = {column.index: other for other, found in candidates.items() for column in found}
    possible = []
    for index, header in enumerate(table.headers):
        name, unit, _ = parsed(header)
        if index in owners:
            if ALIASES.get(name) == signal:
                return InputError(
                    f"no column is left for {signal}: {header!r} is chosen as {owners[index]}",
                    argument=f"columns.{owners[index]}",
                    place=table.header_place,
                )
        elif unit is None or unit.dimension in dimensions(signal, kind):
            possible.append(header)
    if not possible:
        return InputError(
            f"the file has no {signal} column; headers are {listed(table.headers) or 'none'}",
            place=table.header_place,
        )
    likely = [
        header for header in possible if any(part in plain(header) for part in _LIKELY[signal])
    ]
    unrecognised = [header for header in possible if parsed(header)[0] not in ALIASES]
    shown = likely or unrecognised or possible
    return InputError(
        f"no column is recognised as {signal}; candidates are {listed(shown)}",
        place=table.header_place,
        remedy=Action("call", {"columns": {signal: shown[0]}}, function="load"),
    )
