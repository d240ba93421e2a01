"""Columns of a log with the extra signals of a servo."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from jointid.joint.voltage_drive import SIGNALS, VoltageDrive


def servo_columns(
    path: Path, drive: VoltageDrive, stated: Mapping[str, str | int], **parts: Any
) -> dict[str, str | int]:
    """Return the column of each extra signal: from the call, from the joint, or with the signal's name.

    Parameters
    ----------
    **parts
        Options `topic`, `group` and `unpacked` of `load`.
    """
    from jointid.recording.headers import parsed
    from jointid.recording.readers.loading import table_of

    headers = table_of(path, **parts).headers
    own: dict[str, str | int] = {name: name for name in SIGNALS if name in headers}
    for header in headers:
        name, unit, _ = parsed(header)
        if name == "supply" and unit is not None and unit.dimension == "voltage":
            own.setdefault(name, header)
    return own | dict(drive.signals) | dict(stated)
