"""Which column is which signal, and in what unit: headers, `columns=`, `units=`, `scale=`."""

import math
import operator
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from jointid.base.argument_checks import require_mapping
from jointid.base.errors import InputError
from jointid.recording.headers import ALIASES, parsed, plain
from jointid.recording.signals import SIGNALS, FloatArray, check_signal_name, closest, dimensions
from jointid.recording.table import Table
from jointid.recording.units import Unit, unit_named, unit_names

# Signals whose dimension tells the kind of joint, the most telling first.
_TELLING = ("position", "link_position", "reference", "velocity", "torque")
_LIKELY = {"time": ("time", "stamp", "clock"), "position": ("pos", "ang", "travel")}
_SHOWN = 8  # headers listed in a message


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
        What stands where a unit should, but is none. Default: nothing.
    scale : float, optional
        SI value of the file's 1, whatever the unit. Default: the unit tells.
    """

    index: int
    unit: Unit | None
    unknown: str = ""
    scale: float | None = None

    def to_si(self, values: FloatArray) -> FloatArray:
        """Return the column's values in SI units."""
        if self.scale is None:
            return self.unit.to_si(values) if self.unit else values
        with np.errstate(over="ignore", under="ignore"):  # inf is refused by name later
            return values * self.scale


def match_columns(
    table: Table,
    *,
    columns: Mapping[str, str | int | None] | None,
    units: Mapping[str, str] | None,
    scale: Mapping[str, float] | None,
    kind: str | None,
) -> tuple[dict[str, Column], str]:
    """Return the column of each signal present, and the kind of joint their units tell.

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
            raise _missing(table, signal)
    for signal, text in (units or {}).items():
        check_signal_name(signal, "units")
        if not candidates.get(signal):
            raise InputError(
                f"{table.header_place}: units names {signal!r}, but no column is recognised as it"
            )
        unit = unit_named(
            text, dimensions=dimensions(signal, kind), place=f"{table.source}, units[{signal!r}]"
        )
        candidates[signal] = [Column(index=c.index, unit=unit) for c in candidates[signal]]
    for signal, factor in (scale or {}).items():
        check_signal_name(signal, "scale")
        _check_scale(table, signal, factor, units or {})
        if not candidates.get(signal):
            raise InputError(
                f"{table.header_place}: scale names {signal!r}, but no column is recognised as it"
            )
        candidates[signal] = [
            Column(index=c.index, unit=None, scale=float(factor)) for c in candidates[signal]
        ]
    kind = kind or _kind(table, candidates)
    return {
        signal: _the_one(table, signal, candidates[signal], kind)
        for signal in SIGNALS
        if candidates.get(signal)
    }, kind


def _check_scale(table: Table, signal: str, factor: object, units: Mapping[str, str]) -> None:
    number = isinstance(factor, int | float | np.number) and not isinstance(factor, bool)
    if not number or factor == 0 or not math.isfinite(factor):  # type: ignore[arg-type]
        raise InputError(
            f"{table.source}: scale[{signal!r}] is {factor!r}; a finite number other than 0 is "
            "expected, the SI value of the file's 1"
        )
    if signal in units:
        raise InputError(
            f"{table.source}: {signal!r} is in units= and in scale=; one of them tells its size"
        )


def column_index(table: Table, column: object, argument: str) -> int:
    """Return the number of the column that a header or a number names."""
    if isinstance(column, str):
        return _by_header(table, column, argument)
    try:
        if isinstance(column, bool):
            raise TypeError
        index = operator.index(column)  # type: ignore[arg-type]
    except TypeError:
        raise InputError(
            f"{argument} is {column!r}; a header or a 0-based column number is expected"
        ) from None
    if not 0 <= index < len(table.headers):
        raise InputError(
            f"{table.header_place}: {argument} is column {index}; "
            f"the columns are 0 to {len(table.headers) - 1}"
        )
    return index


def _by_header(table: Table, header: str, argument: str) -> int:
    for same in (str.strip, lambda text: text.strip().casefold()):
        found = [k for k, each in enumerate(table.headers) if same(each) == same(header)]
        if len(found) == 1:
            return found[0]
        if found:
            raise InputError(
                f"{table.header_place}: {argument} is {header!r}, which is the header of columns "
                f"{' and '.join(map(str, found))}; give the number"
            )
    if header in table.other_names:
        return table.other_names[header]
    close = closest(header, table.headers)
    meant = f"did you mean {close!r}" if close else f"headers are {_listed(table.headers)}"
    raise InputError(f"{table.header_place}: {argument} is {header!r}, no such header; {meant}")


def _candidates(table: Table, columns: Mapping[str, str | int | None]) -> dict[str, list[Column]]:
    """Return the columns that `columns=` or the header gives to each signal."""
    chosen: dict[int, str] = {}
    for signal, column in columns.items():
        check_signal_name(signal, "columns")
        if column is None:  # leave this signal out
            continue
        index = column_index(table, column, f"columns[{signal!r}]")
        if index in chosen:
            raise InputError(
                f"{table.header_place}: columns gives {table.headers[index]!r} to "
                f"{chosen[index]!r} and {signal!r}; one column holds one signal"
            )
        chosen[index] = signal
    candidates: dict[str, list[Column]] = {}
    for index, header in enumerate(table.headers):
        name, unit, unknown = parsed(header)
        signal_here = chosen.get(index) or ALIASES.get(name)
        if signal_here and (index in chosen or signal_here not in columns):
            column_here = Column(index=index, unit=unit, unknown=unknown)
            candidates.setdefault(signal_here, []).append(column_here)
    return candidates


def _kind(table: Table, candidates: Mapping[str, list[Column]]) -> str:
    for signal in _TELLING:
        kinds = {
            kind: column
            for kind in ("revolute", "prismatic")
            for column in candidates.get(signal, [])
            if column.unit and column.unit.dimension in dimensions(signal, kind)
        }
        if len(kinds) == 2:
            first, second = (table.headers[column.index] for column in kinds.values())
            raise InputError(
                f"{table.header_place}: {first!r} and {second!r} both look like {signal}, of a "
                "revolute and of a prismatic joint; choose with kind= or columns="
            )
        if kinds:
            return next(iter(kinds))
    return "revolute"


def _the_one(table: Table, signal: str, candidates: list[Column], kind: str) -> Column:
    """Return the candidate whose unit fits, the only one that may."""
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
            f"{table.header_place}: {names} both look like {signal}; choose one with "
            f"columns={{{signal!r}: {fitting[0].index}}}"
        )
    header, column = table.headers[candidates[0].index], candidates[0]
    known = ", ".join(unit_names(dimensions(signal, kind)))
    if column.unit is None:
        what = f"names the unknown unit {column.unknown!r}"
    else:
        what = f"is in {column.unit.name} ({column.unit.dimension})"
    wanted = " or ".join(dimensions(signal, kind))
    way_out = "name it with units=, another column with columns="
    if column.unit and column.unit.dimension in ("raw reading", "voltage"):
        way_out = (
            f"give the SI value of 1 with scale={{{signal!r}: ...}}, another column with columns="
        )
    raise InputError(
        f"{table.header_place}: {signal} of a {kind} joint, column {header!r}, {what}; {wanted} "
        f"is expected, in {known}: {way_out}"
    )


def _missing(table: Table, signal: str) -> InputError:
    likely = [
        header for header in table.headers if any(part in plain(header) for part in _LIKELY[signal])
    ]
    strange = [header for header in table.headers if parsed(header)[0] not in ALIASES]
    shown = likely or strange or list(table.headers)
    example = f"columns={{{signal!r}: {shown[0]!r}}}" if shown else "columns="
    return InputError(
        f"{table.header_place}: no column is recognised as {signal}; "
        f"candidates are {_listed(shown)}; choose one with {example}"
    )


def _listed(headers: Sequence[str]) -> str:
    shown = ", ".join(repr(header[:60]) for header in headers[:_SHOWN])
    rest = len(headers) - _SHOWN
    return f"{shown} and {rest} more" if rest > 0 else shown
