"""Command `jointid info` for a log of several joints: one line for each joint."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING, Any

import numpy as np

from jointid.base.errors import InputError
from jointid.base.text_table import aligned
from jointid.cli.reading import how_to_read, joints_wanted, numbers_of_joints

if TYPE_CHECKING:
    from jointid.recording.recording import Recording
    from jointid.recording.wide.robot_recording import RobotRecording

_NOTHING = "–"
_SCALE, _CONSTANT = "scale against the URDF's weight", "torque_constant [N·m/A]"
_HEADS = {_SCALE: "× URDF's weight", _CONSTANT: "torque constant [N·m/A]"}


def several_of(arguments: argparse.Namespace) -> bool:
    """Return whether the command is about several joints: by its options, or because the file has several."""
    wanted = joints_wanted(arguments)
    if arguments.robot is not None or (wanted is not None and len(wanted) != 1):
        return True
    if wanted is not None:
        return False
    from jointid.recording.even_rows import as_stated
    from jointid.recording.readers.loading import table_of
    from jointid.recording.wide.joint_table import several_joints

    reading = how_to_read(arguments)
    try:
        table = table_of(
            arguments.recording, **{name: reading[name] for name in ("topic", "group", "unpacked")}
        )
        table, columns = as_stated(table, reading["sample_period"], reading["columns"])
        return len(several_joints(table, columns)) > 1
    except InputError:  # the reader for one joint reports the error
        return False


def show_robot(arguments: argparse.Namespace) -> None:
    """Print the content of the log, one line for each joint."""
    recordings = _recordings(arguments)
    whole = recordings[0]
    scales, not_weighed = _scales(arguments, whole)
    remarks = [*_remarks(whole), *not_weighed]
    joints = {
        name: _of_joint(each, name, scales.get(name)) for each in recordings for name in each.names
    }
    if arguments.json:
        import json

        document = {"name": whole.name, "kind": whole.kind, "side": whole.side, "joints": joints}
        document["remarks"] = remarks
        print(json.dumps(document, indent=1, ensure_ascii=False))
        return
    print(
        f"{whole.name or 'recording'}: {len(joints)} joints, {whole.kind}, {whole.samples} rows over "
        f"{whole.duration:.6g} s{', of the motors' if whole.side == 'motor' else ''}"
    )
    print(*aligned(_table(joints, weighed=bool(scales))), sep="\n")
    for line in remarks:
        print(line)


def _recordings(arguments: argparse.Namespace) -> list[RobotRecording]:
    """Return the joints on one clock, then each of the others."""
    from jointid.recording.readers.loading_robot import load_robot

    how = how_to_read(arguments)
    whole = load_robot(
        arguments.recording,
        joints_wanted(arguments) or None,
        gear_ratio=numbers_of_joints(arguments, "gear_ratio"),
        **how,
    )
    others = whole.metadata.get("joints_left_out") or {}
    return [whole, *(load_robot(arguments.recording, [name], **how) for name in others)]


def _scales(
    arguments: argparse.Namespace, recording: RobotRecording
) -> tuple[dict[str, float | None], list[str]]:
    """Return each torque over the weight of the URDF's links, by the log's names, or a remark why it is not known."""
    if arguments.robot is None:
        return {}, []
    from jointid.cli.wording import Wording
    from jointid.robot.links.robot import Robot
    from jointid.robot.weight_ratio import weight_scales

    robot = Robot.from_urdf(arguments.robot, facts=arguments.facts)
    try:
        found = weight_scales(recording, robot)
        columns = robot.columns_of(recording)
    except InputError as error:  # the table does not need this
        return {}, [f"not compared with the links' weight: {Wording.of(arguments).of_error(error)}"]
    names = [recording.names[k] for k in columns]
    return {each: found[name] for each, name in zip(names, robot.names, strict=True)}, []


def _of_joint(robot: RobotRecording, name: str, scale: float | None) -> dict[str, Any]:
    from jointid.identification.warnings.inspection import DRIVE, inspect

    one = robot.joint(name)
    signals = [each for each in one.signals if each not in ("time", "velocity")]
    if not one.velocity_derived:
        signals.insert(1, "velocity")
    drive = next((each for each in DRIVE if each in signals), None)
    return {
        "rate [Hz]": float(f"{1.0 / one.sample_period:.4g}"),
        "gaps": len(one.gaps),
        "rows that repeat the position [%]": round(100.0 * inspect(one).stale_share("position"), 2),
        "signals": {
            signal: {
                "min": float(getattr(one, signal).min()),
                "max": float(getattr(one, signal).max()),
                "unit": one.unit(signal),
            }
            for signal in signals
        },
        "torque": None if drive is None else drive,
        "signs": None if drive is None else _signs(one, drive),
        **_weighed(scale, by_current=drive == "current"),
    }


def _signs(recording: Recording, drive: str) -> str:
    """Return the signs of a torque; noise about 0 does not count."""
    from jointid.problem.unsigned_torque import is_one_sided

    values = getattr(recording, drive)
    lowest, highest = float(values.min()), float(values.max())
    if not np.any(values):
        return "always 0"
    if is_one_sided(lowest, highest):
        return "never negative"
    return "never positive" if is_one_sided(-highest, -lowest) else "both"


def _weighed(scale: float | None, *, by_current: bool) -> dict[str, float | None]:
    """Return the torque over the links' weight; for a current, the torque constant from the weight."""
    of_current = 1.0 / scale if scale and by_current else None
    values = {_SCALE: None if by_current else scale, _CONSTANT: of_current}
    return {key: None if each is None else float(f"{each:.3g}") for key, each in values.items()}


def _table(joints: dict[str, dict[str, Any]], *, weighed: bool) -> list[list[str]]:
    head = ["joint", "position", "Hz", "gaps", "repeated", "torque", "signs", "other signals"]
    by_current = {facts["torque"] == "current" for facts in joints.values()}
    last = [key for key in _HEADS if weighed and (key == _CONSTANT) in by_current]
    rows = [[*head, *(_HEADS[key] for key in last)]]
    for name, facts in joints.items():
        drive = facts["torque"]
        signals = facts["signals"]
        others = [each for each in signals if each not in ("position", drive)]
        row = [
            name,
            _range(signals["position"]),
            f"{facts['rate [Hz]']:g}",
            str(facts["gaps"]),
            f"{facts['rows that repeat the position [%]']:g} %",
            _NOTHING if drive is None else _range(signals[drive]),
            facts["signs"] or _NOTHING,
            ", ".join(others) or _NOTHING,
        ]
        rows.append(row + [_NOTHING if facts[key] is None else f"{facts[key]:g}" for key in last])
    return rows


def _range(facts: dict[str, Any]) -> str:
    return f"{facts['min']:.4g} … {facts['max']:.4g} {facts['unit']}"


def _remarks(robot: RobotRecording) -> list[str]:
    """Return remarks on the reading of the file."""
    from jointid.recording.file_remarks import remarks

    assumed = robot.metadata.get("assumed_units")
    found = [f"SI units assumed: {', '.join(map(str, assumed))}"] if assumed else []
    runs = robot.metadata.get("runs")
    if runs:
        found.append(f"runs, one after the other: {', '.join(map(str, runs))}")
    said = remarks(robot.metadata)
    return [*found, f"read: {'; '.join(said)}"] if said else found
