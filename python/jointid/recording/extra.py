"""Extra signals of a recording: arrays under the user's own names, and their columns."""

from __future__ import annotations

import re
from collections.abc import Collection, Mapping
from dataclasses import replace
from types import MappingProxyType

import numpy as np
import numpy.typing as npt

from jointid.base.errors import InputError
from jointid.base.values import dataclass
from jointid.recording.column_lookup import column_index
from jointid.recording.columns import check_scale
from jointid.recording.headers import parsed
from jointid.recording.signals import SIGNALS, FloatArray, shown_dimension, signal_array
from jointid.recording.table import Table
from jointid.recording.units import Unit, unit_named

PREFIX = "extra_"
"""Prefix of an extra signal's header in a saved recording."""

UNITS_KEY = "extra_units"
"""Metadata key: name of an extra signal → text of its unit."""

_NAME = r"[A-Za-z_][A-Za-z0-9_]{0,59}"
_INERTIA = r"[\s_(\[](kg|kgc|gc)[_·*]?m\^?[2²][)\]]?$"  # end of a header such as SIGNAL_kgm2
_INERTIA_FACTORS = {"kg": 1.0, "kgc": 1e-4, "gc": 1e-7}


def checked_extra(extra: object) -> Mapping[str, FloatArray]:
    """Return extra signals as a read-only mapping of read-only arrays.

    Parameters
    ----------
    extra : mapping of str to array_like, each of shape (n,)

    Raises
    ------
    InputError
        The argument is not a mapping, a name is not an identifier or is a signal's name, or values are not numbers.
    """
    if not extra:
        return _NONE
    if not isinstance(extra, Mapping):
        raise InputError(
            "a mapping from names to arrays is expected", argument="extra", value=extra
        )
    arrays: dict[str, FloatArray] = {}
    for name, values in extra.items():
        check_extra_name(name, "extra")
        arrays[name] = signal_array(f"extra.{name}", values)
    return MappingProxyType(arrays)


_NONE: Mapping[str, FloatArray] = MappingProxyType({})


def check_extra_name(name: object, argument: str) -> None:
    """Raise `InputError` for an invalid name of an extra signal."""
    if not isinstance(name, str) or not re.fullmatch(_NAME, name):
        raise InputError(
            "a name of letters, digits and underscores is expected, like q6_rate",
            argument=argument,
            value=name,
        )
    if name in SIGNALS:
        raise InputError(
            "this name is reserved for a signal of recordings",
            argument=argument,
            value=name,
            remedy=f"call it {name}_extra",
        )


@dataclass(frozen=True, kw_only=True)
class ExtraColumn:
    """A column that holds an extra signal.

    Attributes
    ----------
    index : int
        0-based number of the column.
    unit : Unit or None
        Unit in the header. None: no known unit; the values stay unchanged.
    shown : str
        Text of the unit after conversion, e.g. "rad/s"; empty if unknown.
    scale : float, optional
        Factor from file units to SI; replaces the unit's. Default: the unit's factor.
    """

    index: int
    unit: Unit | None = None
    shown: str = ""
    scale: float | None = None

    def to_si(self, values: FloatArray) -> FloatArray:
        """Return the column's values in SI units."""
        if self.scale is not None:
            with np.errstate(over="ignore", under="ignore"):  # inf is refused later, by signal
                return values * self.scale
        return self.unit.to_si(values) if self.unit else values


def extra_columns(
    table: Table,
    wanted: object,
    units: Mapping[str, str] | None = None,
    scale: Mapping[str, float] | None = None,
) -> dict[str, ExtraColumn]:
    """Return the columns of the extra signals that the call names, and of saved extra signals.

    Parameters
    ----------
    table : Table
    wanted : collection of str, mapping of str to str or int, or None
        Headers, which become the names; or name → header or 0-based number.
    units, scale : mapping, optional
        Same as in `load`; entries of other signals are ignored.

    Raises
    ------
    InputError
        An argument has a wrong type, a name is invalid, or there is no such column.
    """
    found: dict[str, ExtraColumn] = {}
    if table.saved is not None:
        for index, header in enumerate(table.headers):
            name = header.removeprefix(PREFIX)
            if name != header and re.fullmatch(_NAME, name):
                found[name] = ExtraColumn(
                    index=index, shown=unit_of_extra(table.saved.get("metadata"), name)
                )
    for name, column in named_extra(wanted).items():
        saved = isinstance(column, str) and column in found and column not in table.headers
        if saved:
            found[name] = found[str(column)]
            continue
        index = column_index(table, column, f"extra.{name}")
        check_extra_name(name, "extra")
        unit = _unit(table.headers[index])
        shown = "" if unit is None else shown_dimension(unit.dimension)
        found[name] = ExtraColumn(index=index, unit=unit, shown=shown)
    for name in found.keys() & (units or {}).keys():
        unit = unit_named((units or {})[name], argument=f"units.{name}", place=table.source)
        found[name] = replace(found[name], unit=unit, shown=shown_dimension(unit.dimension))
    for name in found.keys() & (scale or {}).keys():
        factor = (scale or {})[name]
        check_scale(table, name, factor, units or {})
        found[name] = replace(found[name], scale=float(factor))
    return found


def unit_of_extra(metadata: object, name: str) -> str:
    """Return the text of an extra signal's unit from a recording's metadata; empty if it has none."""
    units = metadata.get(UNITS_KEY) if isinstance(metadata, Mapping) else None
    return str(units.get(name, "")) if isinstance(units, Mapping) else ""


def _unit(header: str) -> Unit | None:
    inertia = re.search(_INERTIA, header.strip())
    if inertia:
        return Unit(name="kgm2", dimension="inertia", factor=_INERTIA_FACTORS[inertia[1]])
    return parsed(header)[1]


def named_extra(wanted: object) -> dict[str, str | int]:
    """Return name → column of the extra signals that a call names; raise `InputError` for a wrong type."""
    if wanted is None:
        return {}
    if isinstance(wanted, Mapping):
        return dict(wanted)
    if isinstance(wanted, str) or not isinstance(wanted, Collection):
        raise InputError(
            "headers of columns, or a mapping from names to headers, are expected",
            argument="extra",
            value=wanted,
        )
    for header in wanted:
        if isinstance(header, str) and not re.fullmatch(_NAME, header):
            raise InputError(
                "this header cannot be the name of a signal; a name has only letters, digits and underscores",
                argument="extra",
                value=header,
                remedy=f"name the signal: extra={{'{_suggested(header)}': {header!r}}}",
            )
    return {str(header): header for header in wanted}


def _suggested(header: str) -> str:
    name = re.sub(r"[^A-Za-z0-9]+", "_", header).strip("_")[:40]
    return name if re.fullmatch(_NAME, name) else f"signal_{name}".rstrip("_")


def rows_of_extra(
    extra: Mapping[str, FloatArray], kept: slice | npt.NDArray[np.generic]
) -> dict[str, FloatArray]:
    """Return some rows of extra signals."""
    return {name: np.asarray(values[kept]) for name, values in extra.items()}
