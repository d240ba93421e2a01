"""Advice for a log without a header of torque: a column that may be the torque, or a servo's log."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from jointid.base.advice import Action
from jointid.base.errors import InputError
from jointid.cli.values import behind_option


def torque_or_servo(path: Path, reading: Mapping[str, Any]) -> Action | None:
    """Return the call with a column that may be the torque; None without one, or if the joints have names.

    Parameters
    ----------
    path : Path
    reading : mapping
        Arguments of `load`, including earlier advice.

    Raises
    ------
    InputError
        The log has a duty or a voltage instead of a torque: it is from a servo.
    """
    from jointid.recording.column_lookup import column_index
    from jointid.recording.even_rows import as_stated
    from jointid.recording.headers import understood
    from jointid.recording.likely_torque import duty_column, quantity_of, torque_column
    from jointid.recording.matching import match_columns
    from jointid.recording.readers.loading import table_of
    from jointid.recording.signals import header_unit

    if reading["joint"] is not None:  # the headers of several joints name the joint of each torque
        return None
    parts = {name: reading[name] for name in ("topic", "group", "unpacked")}
    table = table_of(path, **parts)
    table, columns = as_stated(table, reading["sample_period"], reading["columns"])
    found = match_columns(table, columns=columns, units=None, scale=None, kind=None).found
    taken = {column.index for column in found.values()}
    taken |= {column_index(table, header, "where") for header in reading["where"] or ()}
    position = found["position"].index
    if (index := torque_column(table, taken, position)) is None:
        if (index := duty_column(table, taken, position)) is not None:
            raise _of_servo(path, table.headers[index], reading["where"])
        return None
    header = table.headers[index]
    name = header if table.headers.count(header) == 1 else index
    unit, quantity = understood(header).unit, quantity_of(header)
    volts = unit is not None and unit.dimension == "voltage"
    if quantity and not volts:  # if the header states the unit, it is not requested
        call: dict[str, Any] = {"columns": {quantity: name}}
        units = {} if unit else {"units": {quantity: header_unit(quantity, "revolute")}}
        return Action("call", call | units, "" if unit else "with the unit of this column", "load")
    return Action(
        "call",
        {"columns": {"torque": name}, "scale": {"torque": ...}},
        "if this column is proportional to the torque; state the factor to N·m",
        "load",
    )


def _of_servo(path: Path, header: str, where: Mapping[str, Any] | None) -> InputError:
    """Return the error about a servo's log. A duty times a factor is no torque, because back-EMF brakes, too."""
    runs = f" --by {behind_option(next(iter(where)))}" if where else ""
    return InputError(
        f"the log has no torque: its column '{header}' is the duty or voltage of a servo, not a torque",
        argument="torque",
        place=str(path),
        remedy=f'identify with --joint SERVO.toml{runs} (a joint file with input = "voltage" under [drive]; '
        "docs/servos.md has one)",
    )
