"""Reading the numbers of matched columns: exact stamps, units recognised by the numbers, columns without numbers."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from jointid.base.advice import Action
from jointid.base.errors import InputError
from jointid.recording.columns import Column
from jointid.recording.damaged_rows import RepeatedHeaderError
from jointid.recording.header_words import AT_THE_LINK, is_at_the_link
from jointid.recording.known_products import speed_unit
from jointid.recording.signals import TORQUES, FloatArray
from jointid.recording.stamp_units import unit_of_stamps
from jointid.recording.table import Table
from jointid.recording.time_column import exact_time, stamps_note
from jointid.recording.units import UNITS

_NEEDED = ("time", "position", "torque")
_COARSE = 1e6  # s: rounding errors of larger times exceed 0.1 ns
MOTION = ("velocity", "sensor")  # without these the estimate would change, so the user decides


def read_values(
    table: Table, found: dict[str, Column], left_out: list[dict[str, str]], notes: dict[str, Any]
) -> dict[str, FloatArray]:
    """Return signal → values of its column, in the column's own unit.

    Parameters
    ----------
    table : Table
    found : dict of str to Column
        Signal → its column. Changed in place: recognised unit of time; columns left out are removed.
    left_out : list of dict
        Same as in `Match`; optional columns that cannot be read are appended.
    notes : dict
        Metadata entries; recognised units are added.

    Raises
    ------
    InputError
        A needed cell is not a number, or two units are possible for the stamps.
    """
    values: dict[str, FloatArray] = {}
    if table.saved is None and found["time"].scale is None:
        stamps = exact_time(table, found["time"])
        if stamps is not None:
            values["time"] = stamps.seconds
            found["time"] = replace(found["time"], unit=UNITS["s"], unknown="")
            notes |= stamps_note(stamps)
    numbers = {signal: column.index for signal, column in found.items() if signal not in values}
    try:
        values |= dict(zip(numbers, table.numbers(list(numbers.values())), strict=True))
    except InputError:
        values |= _readable(table, found, numbers, left_out)
    if table.saved is None and found["time"].scale is None and len(values["time"]):
        _recognise_time(table, found, values, notes)
    if table.saved is None and "torque" in found:
        header = table.headers[found["torque"].index]
        notes |= {AT_THE_LINK: header} if is_at_the_link(header) else {}
    _recognise_products(table, found, values, notes)
    return {signal: values[signal] for signal in found}


def with_remedy(error: InputError, signal: str) -> InputError:
    """Return the error with advice to leave the signal out."""
    return InputError(
        error.reason,
        argument=error.argument,
        value=error.value,
        place=error.place,
        remedy=(*error.remedy, Action("call", {"columns": {signal: None}}, function="load")),
    )


def _recognise_time(
    table: Table, found: dict[str, Column], values: dict[str, FloatArray], notes: dict[str, Any]
) -> None:
    """Set the unit of stamps without one; subtract the first stamp if large values would be rounded."""
    time, stamps = found["time"], values["time"]
    first = float(stamps[0])
    with np.errstate(all="ignore"):
        since = stamps - first
    if time.unit is None:
        place = f"{table.header_place}, column {table.headers[time.index]!r}"
        unit = unit_of_stamps(first, since, place)
        if unit is not None:
            time = found["time"] = replace(time, unit=unit)
            notes["recognised_units"] = {"time": unit.name}
    factor = 1.0 if time.unit is None else time.unit.factor
    if _COARSE < abs(first) * factor < np.inf:
        values["time"] = since
        notes["first_stamp"] = repr(first)


def _recognise_products(
    table: Table, found: dict[str, Column], values: dict[str, FloatArray], notes: dict[str, Any]
) -> None:
    """Set units from products' documentation; a servo's velocity gets the unit that agrees with the position's rate."""
    velocity = found.get("velocity")
    if velocity is not None and velocity.documented and len(velocity.documented.units) > 1:
        time, position = (found[name].to_si(values[name]) for name in ("time", "position"))
        unit = speed_unit(time, position, values["velocity"])
        if unit is None:
            raise InputError(
                "servo manuals give units for this column name, but none of these units agrees with the "
                "derivative of the position",
                argument="velocity",
                place=f"{table.header_place}, column {table.headers[velocity.index]!r}",
                remedy=(
                    Action("call", {"scale": {"velocity": ...}}, function="load"),
                    Action("call", {"columns": {"velocity": None}}, function="load"),
                ),
            )
        found["velocity"] = replace(velocity, unit=unit)
    said = {
        signal: f"{column.unit.name}, as {column.documented.source} documents it"
        for signal, column in found.items()
        if column.documented is not None and column.unit is not None
    }
    if said:
        notes["recognised_units"] = {**notes.get("recognised_units", {}), **said}


def _readable(
    table: Table,
    found: dict[str, Column],
    numbers: Mapping[str, int],
    left_out: list[dict[str, str]],
) -> dict[str, FloatArray]:
    """Read columns one by one, because one holds no numbers; optional columns without numbers are left out."""
    for signal, index in numbers.items():
        column = found[signal]
        if table.saved is not None or column.chosen or signal in _NEEDED:
            continue
        try:
            table.numbers([index])
        except RepeatedHeaderError:
            raise
        except InputError as error:
            if signal in MOTION or (signal in TORQUES and not _other_torque(signal, found)):
                raise with_remedy(error, signal) from None
            left_out.append(
                {"column": table.headers[index], "signal": signal, "reason": error.reason}
            )
            del found[signal]
    left = {signal: index for signal, index in numbers.items() if signal in found}
    return dict(zip(left, table.numbers(list(left.values())), strict=True))


def _other_torque(signal: str, found: Mapping[str, Column]) -> bool:
    return any(other in found for other in TORQUES if other != signal)
