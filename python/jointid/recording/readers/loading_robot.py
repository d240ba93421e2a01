"""Loading all joints of a file."""

from collections.abc import Collection, Iterator, Mapping, Sequence
from contextlib import contextmanager
from functools import partial
from typing import Any

import numpy as np

from jointid.base.argument_checks import require_path
from jointid.base.error_text import joint_phrase
from jointid.base.errors import InputError
from jointid.recording.contents import Contents, Rows, read_contents
from jointid.recording.damaged_rows import NOTE
from jointid.recording.even_rows import as_stated
from jointid.recording.extra import named_extra
from jointid.recording.headers import understood
from jointid.recording.readers.loading import file_name, table_of
from jointid.recording.readers.open_files import Source, reads_open_files
from jointid.recording.sides import JOINT, at_joint, stated_sides
from jointid.recording.signals import FloatArray, Kind, TorqueHold
from jointid.recording.unreadable import read_leniently
from jointid.recording.wide.clocks import on_one_clock
from jointid.recording.wide.joint_names import joint_named
from jointid.recording.wide.joint_table import (
    JointTable,
    joints_of,
    nothing_named,
)
from jointid.recording.wide.reading_back import saved_robot
from jointid.recording.wide.robot_recording import RobotRecording
from jointid.recording.wide.robot_signals import LISTED, ROBOT_SIGNALS, checked_ratios

_MOST_JOINTS = 256


@reads_open_files
def load_robot(
    path: Source,
    joints: Sequence[str | int] | str | None = None,
    *,
    columns: Mapping[str, str | int | None] | None = None,
    units: Mapping[str, str] | None = None,
    scale: Mapping[str, float] | None = None,
    gear_ratio: Sequence[float] | FloatArray | float | None = None,
    side: Mapping[str, str] | None = None,
    sample_period: float | None = None,
    where: Mapping[str, float | str] | None = None,
    kind: Kind | None = None,
    torque_hold: TorqueHold | None = None,
    extra: Collection[str] | Mapping[str, str | int] | None = None,
    drop_invalid: bool = False,
    name: str | None = None,
    topic: str | None = None,
    group: str | None = None,
    unpacked: int | None = None,
) -> RobotRecording:
    """Return the recording of several joints in a file.

    Parameters
    ----------
    path : path-like, or open file
        Any file that `load` reads, also one from `RobotRecording.save`.
    joints : sequence of str or int, optional
        Names or numbers of the joints in the headers. If the file has this number of joints but none of these
        names, the joints get these names in order. Default, and "all": all joints in the headers. If a log has
        several clocks (an arm and its gripper), only the joints on the clock with most torques are read, and
        ``metadata["joints_left_out"]`` names the others.
    columns : mapping of str to str, int or None, optional
        Same as in `load`; ``{joint}`` in a header stands for each joint's name:
        ``{"position": "motor_encoder_pos_{joint}_linkside_rad"}``.
    units, scale : mapping, optional
        Same as in `load`, for all joints.
    gear_ratio : sequence of float, optional
        One signed value per joint, in the order of `joints`. Default: not known.
    side, sample_period, where, kind, torque_hold
        Same as in `load`.
    extra : collection of str, or mapping of str to str or int, optional
        Further columns, as in `load`; ``{joint}`` in the header gives one column per joint:
        ``{"model_torque": "model_torque_{joint}_Nm"}``. Default: none.
    drop_invalid : bool
        Same as in `load`. A row with damage in one joint is left out for all joints. Default False.
    name : str, optional
        Default: the saved name, or the file name without its ending.
    topic, group : str, optional
        Same as in `load`.
    unpacked : int, optional
        Same as in `load`.

    Returns
    -------
    RobotRecording
        Signals on the side of the gear from the headers ("motor_position_3_rad": motor side). If one joint has
        signals of both sides, all are on the joint side; this needs `gear_ratio`.

    Raises
    ------
    InputError
        The headers name no joints, or a joint's columns do not form a recording; the error names joint and header.

    Examples
    --------
    >>> robot = jid.load("arm.csv", joints="all", gear_ratio=[32, 32, 45, -48, 45, 32])
    >>> elbow = robot.joint(3)
    """
    file = require_path("path", path)
    table = table_of(file, topic=topic, group=group, kind=kind, unpacked=unpacked)
    whole = saved_robot(table)
    if whole is not None and not (
        columns or units or scale or side or where or kind or torque_hold or extra
    ):
        return _changed(whole, joints, gear_ratio, name)
    table, columns = as_stated(table, sample_period, columns)
    known = joints_of(table, columns)
    if not known:
        raise nothing_named(table, "all" if joints is None else joints, "joints")
    names = _wanted(joints, known, table.header_place)
    if len(names) > _MOST_JOINTS:
        raise InputError(
            f"the robot has {len(names)} joints; at most {_MOST_JOINTS} are read",
            argument="joints",
            place=table.header_place,
            remedy="name the joints that belong together",
        )
    wanted = named_extra(extra)
    tables = [JointTable(table, each, columns or {}, wanted) for each in names]

    present = {signal for one in tables for signal in _signals(one)}

    def contents(one: JointTable) -> Contents:
        read = partial(
            read_contents,
            columns=one.columns,
            units=_of_present(units, one, present),
            scale=_of_present(scale, one, present),
            extra=one.extra,
            kind=kind,
            torque_hold=torque_hold,
        )
        return read_leniently(read, one, drop_invalid=drop_invalid)

    sound: dict[
        int, Rows
    ] = {}  # by the number of the log's rows, because each clock has different rows
    if drop_invalid:
        for each, one in zip(names, tables, strict=True):
            with _of_joint(each):
                held = contents(one)
                undamaged, _ = held.sound_rows(_where(held, where))
            samples = len(held.values["time"])
            sound[samples] = np.intersect1d(sound.get(samples, undamaged), undamaged)

    def rows(held: Contents) -> Rows | None:
        return sound[len(held.values["time"])] if drop_invalid else _where(held, where)

    fields, dropped = [], []
    for each, one in zip(names, tables, strict=True):
        with _of_joint(each):
            held = contents(one)
            fields.append(held.fields(rows(held)))
            dropped.append(_count(held, _where(held, where)) - _count(held, rows(held)))
    if any("repeated_rows" in each.get("metadata", {}) for each in fields):
        every = [contents(one) for one in tables]
        fields = _once(every, rows(every[0]))
    kept, left_out = on_one_clock(
        names, fields, table.source, named=joints is not None and joints != "all"
    )
    names, tables = [names[k] for k in kept], [tables[k] for k in kept]
    fields = [fields[k] for k in kept]
    each_side = [stated_sides(one.side, one.other_sides, side) for one in tables]
    sides = {own for own, _ in each_side}
    if whole is not None:  # a saved robot's headers do not state the side
        sides = {whole.side}
        if gear_ratio is None and whole.gear_ratio is not None:
            gear_ratio = [whole.gear_ratio[whole.names.index(each)] for each in names]
    if len(sides) > 1:
        shown = ", ".join(f"{each}: {own}" for each, (own, _) in zip(names, each_side, strict=True))
        raise InputError(
            f"some positions are on the motor side, others on the joint side ({shown})",
            argument="joints",
            place=table.header_place,
            remedy="load only joints of one side",
        )
    if any(others for _, others in each_side):
        fields = _at_joint(names, tables, fields, gear_ratio, each_side)
        sides = {JOINT}
    first = {key: value for key, value in fields[0].items() if key not in ROBOT_SIGNALS}
    # Keep only one copy of a long log: the table and its columns are no longer needed.
    del table, tables, one, held
    return RobotRecording(
        time=first["time"],
        **_stacked(fields),  # type: ignore[arg-type]
        side=sides.pop(),
        gear_ratio=gear_ratio,
        names=names,
        extra=_extra(wanted, fields),
        kind=first["kind"],
        torque_hold=first.get("torque_hold"),
        name=file_name(file, first, name),
        metadata=_metadata(
            first,
            left_out,
            dropped=dropped[kept[0]],
            listed=joints is not None and joints != "all",
        ),
    )


def _metadata(
    first: Mapping[str, Any], left_out: Mapping[str, str], *, dropped: int, listed: bool
) -> Mapping[str, Any]:
    """Return metadata: how the file was read, joints and rows left out, and whether the joints were listed."""
    found = dict(first.get("metadata") or {})
    if left_out:
        found["joints_left_out"] = dict(left_out)
    if dropped:
        found[NOTE] = dropped
    return {**found, LISTED: True} if listed else found


@contextmanager
def _of_joint(name: str) -> Iterator[None]:
    """Add the joint to the place of an error."""
    try:
        yield
    except InputError as error:
        raise error.at(joint_phrase(name)) from None


def _where(held: Contents, where: Mapping[str, float | str] | None) -> Rows | None:
    return held.rows_where(where) if where else None


def _count(held: Contents, rows: Rows | None) -> int:
    return len(held.values["time"] if rows is None else rows)


def _once(contents: Sequence[Contents], rows: Rows | None) -> list[dict[str, Any]]:
    """Return each joint's arguments, without rows that are copies for all joints."""
    if rows is None:
        rows = np.arange(len(contents[0].values["time"]))
    every = [each.once(rows) for each in contents]
    kept = np.unique(np.concatenate([rows if each is None else each for each in every]))
    fields = [each.fields(kept) for each in contents]
    for each in fields:
        each["metadata"] = {**each.get("metadata", {}), "repeated_rows": len(rows) - len(kept)}
    return fields


def _at_joint(
    names: Sequence[str],
    tables: Sequence[JointTable],
    fields: Sequence[Mapping[str, Any]],
    gear_ratio: Sequence[float] | FloatArray | float | None,
    sides: Sequence[tuple[str, Mapping[str, str]]],
) -> list[dict[str, Any]]:
    """Return all signals on the joint side, because one joint has signals of both sides."""
    ratios = checked_ratios(gear_ratio, len(names)) or (None,) * len(names)
    found = []
    for name, one, held, ratio, (own, others) in zip(
        names, tables, fields, ratios, sides, strict=True
    ):
        try:
            there = at_joint(held, own, ratio, others)
        except InputError as error:
            raise error.at(f"{one.header_place}, {joint_phrase(name)}") from None
        found.append({**held, **{key: there[key] for key in there if key != "metadata"}})
    return found


def _wanted(
    joints: Sequence[str | int] | str | None, known: tuple[str, ...], place: str
) -> list[str]:
    if joints is None or joints == "all":
        return list(known)
    if isinstance(joints, str | int):
        joints = [joints]
    names = [joint_named(each, known, place, "joints", "load_robot") for each in joints]
    twice = next((name for name in names if names.count(name) > 1), None)
    if twice is not None or not names:
        raise InputError(
            "it is named twice" if names else "at least one joint is expected",
            argument="joints",
            value=twice if names else [],
            place=place,
        )
    return names


def _of_present(
    values: Mapping[str, Any] | None, one: JointTable, present: Collection[str]
) -> Mapping[str, Any] | None:
    """Return units and factors without signals that only other joints have; signals of no joint are refused later."""
    if not isinstance(values, Mapping):
        return values
    absent = {*present} - _signals(one)
    return {signal: value for signal, value in values.items() if signal not in absent}


def _signals(one: JointTable) -> set[str]:
    """Return the signals of a joint with a chosen column or a matching header, in any unit."""
    meanings = [understood(header).meaning for header in one.headers]
    named = {each.signal for each in meanings if each is not None}
    return {each for each in named | {*one.columns} if one.columns.get(each, ...) is not None}


def _stacked(fields: Sequence[dict[str, Any]]) -> dict[str, FloatArray]:
    """Return each signal's columns side by side, NaN for a joint without the signal; remove them from `fields`."""
    length = len(fields[0]["time"])
    stacked = {}
    for signal in ROBOT_SIGNALS:
        if any(each.get(signal) is not None for each in fields):
            matrix = np.empty((length, len(fields)), order="F")
            for joint, each in enumerate(fields):
                column = each.pop(signal, None)
                matrix[:, joint] = np.nan if column is None else column
            matrix.flags.writeable = False
            stacked[signal] = matrix
    return stacked


def _extra(
    wanted: Mapping[str, str | int], fields: Sequence[Mapping[str, Any]]
) -> dict[str, FloatArray]:
    """Return each extra signal; with one column per joint if every joint has its own."""
    found = {}
    for name, header in wanted.items():
        each = [own["extra"][name] for own in fields]
        found[name] = np.column_stack(each) if "{joint}" in str(header) else each[0]
    return found


def _changed(
    robot: RobotRecording,
    joints: Sequence[str | int] | str | None,
    gear_ratio: Sequence[float] | FloatArray | float | None,
    name: str | None,
) -> RobotRecording:
    """Return a saved recording with the call's changes, or some of its joints."""
    if joints is not None and joints != "all":
        robot = robot.select(_wanted(joints, robot.names, robot.name))
    if gear_ratio is not None:
        robot = robot.with_gear_ratio(gear_ratio)
    return robot if name is None else RobotRecording(**{**robot.fields(), "name": name})
