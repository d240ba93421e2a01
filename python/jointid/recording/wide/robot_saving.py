"""Writing a robot's recording: .csv, .csv.gz and .npz, which `load` reads back bit for bit."""

import io
import json
import os
from typing import Any

import numpy as np

from jointid.base.argument_checks import require_path
from jointid.base.errors import InputError
from jointid.base.file_endings import ending_of
from jointid.base.files import write_whole
from jointid.recording.extra import PREFIX as EXTRA
from jointid.recording.saved import CSV_MARK, NPZ_MEMBER, SCHEMA
from jointid.recording.saving import ENDINGS
from jointid.recording.signals import FloatArray, header_unit
from jointid.recording.wide.robot_samples import RobotSamples


def save_robot(robot: RobotSamples, path: str | os.PathLike[str]) -> None:
    """Write a robot's recording to a file: see `RobotRecording.save`."""
    target = require_path("path", path)
    ending = ending_of(target, ENDINGS)
    if target.is_dir():
        raise InputError("this is a folder; a file name is expected", place=str(target))
    content = _npz(robot) if ending == ".npz" else _csv(robot)
    if ending == ".csv.gz":
        # No time stamp inside: the same recording gives the same file.
        import gzip

        content = gzip.compress(content, compresslevel=6, mtime=0)
    write_whole(target, content)


def column_header(robot: RobotSamples, signal: str, joint: str) -> str:
    """Return the header of a joint's column in a saved file: ``elbow.position [rad]``."""
    return f"{joint}.{signal} [{header_unit(signal, robot.kind)}]"


def _columns(robot: RobotSamples) -> dict[str, FloatArray]:
    columns = {f"time [{header_unit('time', robot.kind)}]": robot.time}
    for signal in robot.signals[1:]:
        values = getattr(robot, signal)
        for column, joint in enumerate(robot.names):
            if not np.isnan(values[0, column]):
                columns[column_header(robot, signal, joint)] = values[:, column]
    for name, values in robot.extra.items():
        if values.ndim == 1:
            columns[f"{EXTRA}{name}"] = values
        else:
            for column, joint in enumerate(robot.names):
                columns[f"{joint}.{EXTRA}{name}"] = values[:, column]
    return columns


def _attributes(robot: RobotSamples) -> str:
    attributes: dict[str, Any] = {
        name: getattr(robot, name) for name in ("name", "kind", "torque_hold", "velocity_derived")
    }
    attributes |= {"metadata": dict(robot.metadata), "truth": None}
    attributes["robot"] = {
        "names": list(robot.names),
        "side": robot.side,
        "gear_ratio": None if robot.gear_ratio is None else list(robot.gear_ratio),
        "signals": list(robot.signals[1:]),
        "extra": {name: values.ndim for name, values in robot.extra.items()},
    }
    return json.dumps({"schema": SCHEMA, **attributes})


def _csv(robot: RobotSamples) -> bytes:
    columns = _columns(robot)
    rows = (
        ",".join(map(repr, row))
        for row in zip(*(v.tolist() for v in columns.values()), strict=True)
    )
    lines = [CSV_MARK + _attributes(robot), ",".join(columns), *rows, ""]
    return "\n".join(lines).encode()


def _npz(robot: RobotSamples) -> bytes:
    arrays = {name: np.ascontiguousarray(values) for name, values in _columns(robot).items()}
    arrays[NPZ_MEMBER] = np.array(_attributes(robot))
    stream = io.BytesIO()
    np.savez_compressed(stream, allow_pickle=False, **arrays)
    return stream.getvalue()
