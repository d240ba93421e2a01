"""Loading a recording from a file."""

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from jointid.errors import InputError
from jointid.recording.columns import Column, Table, column_index, match_columns
from jointid.recording.csv_reader import CsvTable
from jointid.recording.npz_reader import NpzTable
from jointid.recording.recording import Recording, check_kind, check_torque_hold
from jointid.recording.saving import ending_of
from jointid.recording.signals import check_signals


def load(
    path: str | os.PathLike[str],
    *,
    columns: Mapping[str, str | int | None] | None = None,
    units: Mapping[str, str] | None = None,
    where: Mapping[str, float | str] | None = None,
    kind: str | None = None,
    torque_hold: str | None = None,
    name: str | None = None,
) -> Recording:
    """Return the recording that a file holds.

    Headers are a signal's name with its unit: ``position_rad``, ``velocity [deg/s]``,
    ``torque_Nm``, ``time_ms``; any case. Known names are time (t), position (pos, angle, q),
    velocity (vel, speed), torque (tau, force, motor_force, motor_torque_output, output_torque),
    sensor (sensor_raw, torque_sensor), reference (position_ref, position_reference,
    goal_position), link_position, temperature, motor_torque and current (motor_current).
    A signal without a unit is taken as SI and listed in ``metadata["assumed_units"]``.

    Parameters
    ----------
    path : path-like
        A ``.csv``, ``.csv.gz`` or ``.npz`` file, foreign or written by `Recording.save`.
    columns : mapping of str to str, int or None, optional
        Signal → header or 0-based number of its column; None leaves the signal out (a velocity
        left out is derived from position). Default: by the headers, also for signals not mapped.
    units : mapping of str to str, optional
        Signal → unit, e.g. ``{"position": "deg"}``, whatever the header says.
        Default: the header's.
    where : mapping of str to number or str, optional
        Header → value: only rows with this value are kept. Default: all rows.
    kind : {"revolute", "prismatic"}, optional
        Default: what the units tell, ``"prismatic"`` for metres or newtons, else ``"revolute"``.
    torque_hold : {"zoh", "linear"}, optional
        How the torque lives between samples. Default: what was saved, else not known.
    name : str, optional
        Default: what was saved, else the file's name without its ending.

    Returns
    -------
    Recording

    Raises
    ------
    InputError
        The file cannot be read or its columns hold no recording: one sentence that names the
        file, the line or the header, and what would be right.
    """
    file = Path(path)
    ending = ending_of(file)
    table: CsvTable | NpzTable
    try:
        table = NpzTable(file) if ending == ".npz" else CsvTable(file)
    except FileNotFoundError:
        raise InputError(f"{file}: there is no such file") from None
    except IsADirectoryError:
        raise InputError(f"{file}: this is a folder; the name of a file is expected") from None
    except OSError as error:
        raise InputError(f"{file}: the file cannot be read ({error.strerror})") from None
    fields = fields_from(
        table, columns=columns, units=units, where=where, kind=kind, torque_hold=torque_hold
    )
    fields.setdefault("name", file.name[: -len(ending)])
    if name is not None:
        fields["name"] = name
    try:
        return Recording(**fields)
    except InputError as error:
        raise InputError(f"{file}: {error}") from None


def fields_from(
    table: Table,
    *,
    columns: Mapping[str, str | int | None] | None = None,
    units: Mapping[str, str] | None = None,
    where: Mapping[str, float | str] | None = None,
    kind: str | None = None,
    torque_hold: str | None = None,
) -> dict[str, Any]:
    """Return the arguments of `Recording` that a table holds; parameters are those of `load`.

    Raises
    ------
    InputError
        As `load`.
    """
    if kind is not None:
        check_kind(kind)
    check_torque_hold(torque_hold)
    saved = dict(table.saved or {})
    saved_kind = saved.get("kind")
    if kind is not None and saved_kind not in (None, kind):
        raise InputError(
            f"{table.source}: the recording was saved as {saved_kind}, not {kind}; leave kind= out"
        )
    found, kind = match_columns(table, columns=columns, units=units, kind=kind or saved_kind)
    values = dict(
        zip(found, table.numbers([column.index for column in found.values()]), strict=True)
    )
    rows = _rows(table, where, len(values["time"])) if where else None
    signals = {}
    for signal, column in found.items():
        chosen = values[signal] if rows is None else values[signal][rows]
        signals[signal] = column.unit.to_si(chosen) if column.unit else chosen

    def place(signal: str, index: int) -> str:
        return table.place(found[signal].index, index if rows is None else int(rows[index]))

    check_signals(
        signals,
        place=place,
        source=table.source,
        time_advice="" if where else ' (of several runs in a file choose one: where={"run": 1})',
    )
    if columns and "velocity" in columns:
        saved.pop("velocity_derived", None)
    fields = {**saved, **signals, "kind": kind}
    if torque_hold is not None:
        fields["torque_hold"] = torque_hold
    if table.saved is None:
        fields["metadata"] = _assumed(found)
    return fields


def _assumed(found: Mapping[str, Column]) -> dict[str, list[str]]:
    # A sensor's reading has no unit of its own: nothing is assumed there.
    assumed = [
        signal for signal, column in found.items() if column.unit is None and signal != "sensor"
    ]
    return {"assumed_units": assumed} if assumed else {}


def _rows(table: Table, where: Mapping[str, float | str], length: int) -> npt.NDArray[np.intp]:
    """Return the numbers of the rows that `where` keeps."""
    kept = np.ones(length, dtype=np.bool_)
    for header, wanted in where.items():
        column = column_index(table, header, "where")
        if isinstance(wanted, str):
            cells = table.text(column)
            matches = np.array([cell == wanted for cell in cells], dtype=np.bool_)
            present = list(dict.fromkeys(cells))
        elif isinstance(wanted, int | float | np.number):
            (numbers,) = table.numbers([column])
            matches = numbers == float(wanted)
            present = [f"{value:g}" for value in dict.fromkeys(numbers.tolist())]
        else:
            raise InputError(
                f"{table.source}: where[{header!r}] is {wanted!r}; a number or text is expected"
            )
        if len(matches) != length:
            raise InputError(
                f"{table.source}: where names {header!r} with {len(matches)} samples, time has "
                f"{length}"
            )
        if not matches.any():
            shown = ", ".join(present[:8]) + (", ..." if len(present) > 8 else "")
            raise InputError(
                f"{table.source}: no row has {wanted!r} in column {header!r}; it holds {shown}"
            )
        kept &= matches
    if not kept.any():
        raise InputError(f"{table.source}: no row meets all of where={dict(where)!r}")
    return np.flatnonzero(kept)
