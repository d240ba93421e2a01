"""Reading files from `RobotRecording.save`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from jointid.base.errors import InputError
from jointid.recording.extra import PREFIX as EXTRA
from jointid.recording.signals import KINDS, header_unit
from jointid.recording.table import Table

if TYPE_CHECKING:
    from jointid.recording.wide.robot_recording import RobotRecording


def saved_robot(table: Table) -> RobotRecording | None:
    """Return the recording that a table was saved from; None for other tables.

    Raises
    ------
    InputError
        The file's description does not fit its columns.
    """
    saved = table.saved
    robot = None if saved is None else saved.get("robot")
    if saved is None or robot is None:
        return None
    from jointid.recording.wide.robot_recording import RobotRecording
    from jointid.recording.wide.robot_signals import ROBOT_SIGNALS

    try:
        names, signals, extra = robot["names"], robot["signals"], robot["extra"]
        fields = {key: robot[key] for key in ("side", "gear_ratio")}
        if not {"position"} <= set(signals) <= set(ROBOT_SIGNALS) or saved.get("kind") not in KINDS:
            raise ValueError
        kind = str(saved["kind"])
        wanted: dict[str, list[str]] = {"time": [f"time [{header_unit('time', kind)}]"]}
        for signal in signals:
            unit = header_unit(signal, kind)
            wanted[signal] = [f"{name}.{signal} [{unit}]" for name in names]
        shared = {name for name, dimensions in extra.items() if dimensions == 1}
        for name in extra:
            inside = f"{EXTRA}{name}"
            wanted[inside] = [inside] if name in shared else [f"{one}.{inside}" for one in names]
        arrays = _arrays(table, wanted)
    except (KeyError, TypeError, ValueError, AttributeError):
        raise InputError(
            "the description of the recording does not fit its columns", place=table.source
        ) from None
    values = {signal: arrays[signal] for signal in signals}
    values["time"] = arrays["time"][:, 0]
    values["extra"] = {
        name: arrays[f"{EXTRA}{name}"][:, 0] if name in shared else arrays[f"{EXTRA}{name}"]
        for name in extra
    }
    attributes = {key: value for key, value in saved.items() if key not in ("truth", "robot")}
    try:
        return RobotRecording(**values, **fields, **attributes, names=names)
    except InputError as error:
        raise error.at(table.source) from None


def _arrays(table: Table, wanted: dict[str, list[str]]) -> dict[str, Any]:
    """Return signal → array with one column per joint; NaN for a joint without the signal."""
    at = {header: index for index, header in enumerate(table.headers)}
    present = [header for headers in wanted.values() for header in headers if header in at]
    columns = dict(zip(present, table.numbers([at[header] for header in present]), strict=True))
    absent = np.full(len(columns[wanted["time"][0]]), np.nan)
    return {
        signal: np.column_stack([columns.get(header, absent) for header in headers])
        for signal, headers in wanted.items()
    }
