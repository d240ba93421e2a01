"""The column, unit and scale of each signal: from the headers, and from `columns`, `units` and `scale`."""

import math
from collections.abc import Mapping
from dataclasses import field, replace

import numpy as np

from jointid.base.argument_checks import require_mapping
from jointid.base.errors import InputError
from jointid.base.values import dataclass
from jointid.recording.column_lookup import column_index
from jointid.recording.header_words import OF_A_JOINT, PLAIN
from jointid.recording.headers import understood
from jointid.recording.known_products import Documented, unit_in_table
from jointid.recording.signals import FloatArray, check_signal_name, dimensions
from jointid.recording.stamps import fractions
from jointid.recording.table import Table
from jointid.recording.units import Unit, unit_named


@dataclass(frozen=True, kw_only=True)
class Column:
    """A column that holds a signal.

    Attributes
    ----------
    index : int
        0-based number of the column.
    unit : Unit or None
        Unit of the values. None: none is stated, SI is assumed.
    unknown : str
        Text at the unit's place in the header that is no known unit. Default: none.
    scale : float, optional
        Factor from file units to SI; replaces the unit. Default: the unit's factor.
    chosen : bool
        Whether the call's `columns` named the column. Default: its header did.
    rank : int
        How clearly the header names the signal, as in `Meaning`. Default: most clearly.
    joint : str
        Number or name of the joint in the header. Default: none.
    documented : Documented or None
        The product's documentation, if it gave the unit. Default: none.
    overridden : str
        The unit in the header or the product's documentation, if the call states another one. Default: none.
    """

    index: int
    unit: Unit | None
    unknown: str = ""
    scale: float | None = None
    chosen: bool = False
    rank: int = PLAIN
    joint: str = ""
    documented: Documented | None = None
    overridden: str = ""

    def to_si(self, values: FloatArray) -> FloatArray:
        """Return the column's values in SI units."""
        if self.scale is None:
            return self.unit.to_si(values) if self.unit else values
        with np.errstate(over="ignore", under="ignore"):  # inf is refused later, by signal
            return values * self.scale

    def fits(self, signal: str, kind: str) -> bool:
        """Whether the column's unit fits the signal, or no unit is stated."""
        return not self.unknown and (
            self.unit is None or self.unit.dimension in dimensions(signal, kind)
        )


@dataclass(frozen=True, kw_only=True)
class Candidates:
    """The columns that may hold each signal.

    Attributes
    ----------
    of : dict of str to list of Column
        Signal → columns.
    of_joints : dict of str to list of Column
        Signal → columns of several joints; none of them is used until a joint is chosen.
    """

    of: dict[str, list[Column]] = field(default_factory=dict)
    of_joints: dict[str, list[Column]] = field(default_factory=dict)


def candidates_of(
    table: Table,
    *,
    columns: Mapping[str, str | int | None] | None,
    units: Mapping[str, str] | None,
    scale: Mapping[str, float] | None,
    kind: str | None,
) -> Candidates:
    """Return the columns of each signal, assigned by `columns` or by headers, with units and scales.

    Parameters
    ----------
    table : Table
    columns, units, scale, kind
        Same as in `load`.

    Raises
    ------
    InputError
        A header, signal or unit does not exist, or one column is given for two signals.
    """
    for name, mapping, example in (
        ("columns", columns, "{'position': 'enc1'}"),
        ("units", units, "{'position': 'deg'}"),
        ("scale", scale, "{'position': 0.001}"),
    ):
        if mapping is not None:
            require_mapping(name, mapping, example)
    found = _of_one_joint(_candidates(table, columns or {}))
    candidates = found.of
    complete = all(candidates.get(signal) for signal in ("time", "position"))
    for signal, text in (units or {}).items():
        check_signal_name(signal, "units")
        if complete:
            _check_recognised(table, signal, candidates, f"units.{signal}")
        unit = unit_named(
            text,
            dimensions=dimensions(signal, kind),
            argument=f"units.{signal}",
            place=table.source,
        )
        candidates[signal] = [
            replace(
                column,
                unit=unit,
                unknown="",
                documented=None,
                overridden=_other_unit(column, unit),
            )
            for column in candidates.get(signal, [])
        ]
    for signal, factor in (scale or {}).items():
        check_signal_name(signal, "scale")
        check_scale(table, signal, factor, units or {})
        if complete:
            _check_recognised(table, signal, candidates, f"scale.{signal}")
        candidates[signal] = [
            replace(
                column,
                unit=None,
                unknown="",
                scale=float(factor),
                documented=None,
                overridden="" if column.fits(signal, kind or "revolute") else _measured(column),
            )
            for column in candidates.get(signal, [])
        ]
    return found


def _other_unit(column: Column, unit: Unit) -> str:
    """Return the unit stated for a column if it differs from this unit."""
    stated = column.unit
    return stated.name if stated and _measured(column) and stated.name != unit.name else ""


def _measured(column: Column) -> str:
    """Return the unit stated for a column; empty for a raw reading, which needs a factor."""
    reading = column.unit is None or column.unit.dimension in ("raw reading", "voltage")
    return "" if reading or column.unit is None else column.unit.name


def _check_recognised(
    table: Table, signal: str, candidates: Mapping[str, list[Column]], argument: str
) -> None:
    if not candidates.get(signal):
        raise InputError(
            f"no column is recognised as {signal}", argument=argument, place=table.header_place
        )


def check_scale(table: Table, signal: str, factor: object, units: Mapping[str, str]) -> None:
    """Refuse a factor that is 0 or not finite, or that is given together with a unit."""
    number = isinstance(factor, int | float | np.number) and not isinstance(factor, bool)
    if not number or factor == 0 or not math.isfinite(factor):  # type: ignore[arg-type]
        raise InputError(
            "the factor from file units to SI is expected, a finite number other than 0",
            argument=f"scale.{signal}",
            value=factor,
            place=table.source,
        )
    if signal in units:
        raise InputError(
            f"{signal} also has the unit {units[signal]!r}; give only its scale or only its unit",
            argument=f"scale.{signal}",
            value=factor,
            place=table.source,
        )


def _candidates(table: Table, columns: Mapping[str, str | int | None]) -> dict[str, list[Column]]:
    chosen: dict[int, str] = {}
    for signal, column in columns.items():
        check_signal_name(signal, "columns")
        if column is None:  # leave this signal out
            continue
        index = column_index(table, column, f"columns.{signal}")
        if index in chosen:
            raise InputError(
                f"this column is also chosen as {chosen[index]}; each signal needs a column of its own",
                argument=f"columns.{signal}",
                value=column,
                place=table.header_place,
            )
        chosen[index] = signal
    candidates: dict[str, list[Column]] = {}
    parts = fractions(table.headers) if table.saved is None else frozenset()
    for index, header in enumerate(table.headers):
        read = understood(header)
        meaning = read.meaning
        if index in chosen:
            column_here = Column(index=index, unit=read.unit, unknown=read.unknown, chosen=True)
            column_here = _as_documented(table, column_here, chosen[index])
            candidates.setdefault(chosen[index], []).append(column_here)
        elif index not in parts and meaning is not None and meaning.signal not in columns:
            if table.saved is None:
                if meaning.signal == "late":
                    continue  # in other files a column with this name may be anything
            elif meaning.rank != PLAIN:
                continue  # a saved recording uses the signals' own names
            column_here = Column(
                index=index,
                unit=read.unit,
                unknown=read.unknown,
                rank=meaning.rank,
                joint=meaning.joint,
            )
            column_here = _as_documented(table, column_here, meaning.signal)
            candidates.setdefault(meaning.signal, []).append(column_here)
    return candidates


def _as_documented(table: Table, column: Column, signal: str) -> Column:
    """Return a column without a unit in its header with the unit from the product's documentation."""
    known = understood(table.headers[column.index]).documented
    if table.saved is not None or known is None or known.signal != signal:
        return column
    if column.unit is not None or column.unknown:
        return column
    unit = unit_in_table(known, table, column.index)
    return column if unit is None else replace(column, unit=unit, documented=known)


def _of_one_joint(candidates: dict[str, list[Column]]) -> Candidates:
    """Keep the columns of one joint; set columns of several joints aside until a joint is chosen."""

    def clearest(signal: str) -> list[Column]:
        found = candidates.get(signal, [])
        return [column for column in found if column.rank == min(each.rank for each in found)]

    numbered = {c.joint for c in clearest("position") if c.rank == OF_A_JOINT}
    kept, left = Candidates(), {}
    for signal in candidates:
        found = candidates[signal]
        if len(numbered) == 1 and any(column.joint in numbered for column in found):
            found = [column for column in found if column.joint in ("", *numbered)]
        several = {column.joint for column in found if column.rank == OF_A_JOINT}
        if len(several) > 1 or (several and len(numbered) > 1) or (several - numbered and numbered):
            left[signal] = [column for column in found if column.rank == OF_A_JOINT]
            found = [column for column in found if column.rank != OF_A_JOINT]
        kept.of[signal] = found
    return Candidates(of=kept.of, of_joints=left)
