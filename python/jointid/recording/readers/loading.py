"""Loading recordings from files."""

import re
from collections.abc import Collection, Mapping
from functools import partial
from pathlib import Path
from typing import Any

from jointid.base.advice import Action
from jointid.base.argument_checks import require_path
from jointid.base.errors import InputError
from jointid.base.file_endings import ending_of
from jointid.base.unpacking import allowing
from jointid.recording.attributes import check_kind
from jointid.recording.column_lookup import column_index
from jointid.recording.contents import Contents, read_contents
from jointid.recording.damaged_rows import NOTE
from jointid.recording.even_rows import as_stated
from jointid.recording.held_rows import without_copies
from jointid.recording.readers.list_columns import with_list_columns
from jointid.recording.readers.open_files import Source, reads_open_files
from jointid.recording.readers.reader import Reader
from jointid.recording.readers.registry import reader_of
from jointid.recording.recording import Recording
from jointid.recording.signals import Kind, TorqueHold
from jointid.recording.table import MOST_COLUMNS, Table
from jointid.recording.unreadable import read_leniently
from jointid.recording.wide.joint_in_table import joint_of_table
from jointid.recording.wide.one_joint import OneJoint, of_joint

_SURROGATE = "[\ud800-\udfff]"
_SORT = "sort the rows by time, or cut the file at the start of its second run"


@reads_open_files
def load(
    path: Source,
    *,
    joint: str | int | None = None,
    columns: Mapping[str, str | int | None] | None = None,
    units: Mapping[str, str] | None = None,
    scale: Mapping[str, float] | None = None,
    extra: Collection[str] | Mapping[str, str | int] | None = None,
    gear_ratio: float | None = None,
    side: Mapping[str, str] | None = None,
    sample_period: float | None = None,
    where: Mapping[str, float | str] | None = None,
    kind: Kind | None = None,
    torque_hold: TorqueHold | None = None,
    drop_copies: bool = False,
    drop_invalid: bool = False,
    name: str | None = None,
    topic: str | None = None,
    group: str | None = None,
    unpacked: int | None = None,
) -> Recording:
    """Return the recording in a file; see the function `load` for the options."""
    file = require_path("path", path)
    try:
        table = table_of(file, topic=topic, group=group, kind=kind, unpacked=unpacked)
    except InputError as error:
        if joint is not None or topic is not None or group is not None:
            raise
        from jointid.recording.wide.choosing import also_joints

        raise also_joints(
            error, partial(table_of, file, kind=kind, unpacked=unpacked), columns
        ) from None
    table, columns = as_stated(table, sample_period, columns)
    one = joint_of_table(table, joint, columns, extra)
    ratio = _ratio(one, gear_ratio)
    read = partial(
        read_contents,
        columns=one.columns,
        units=units,
        scale=scale,
        extra=one.extra,
        kind=kind,
        torque_hold=torque_hold,
    )
    contents = read_leniently(read, one.table, drop_invalid=drop_invalid)
    rows = contents.rows_where(where) if where else None
    dropped = 0
    if drop_invalid:
        sound, dropped = contents.sound_rows(rows)
        rows = sound if dropped else rows
    remedy = partial(_one_run, contents) if rows is None else tuple
    fields = contents.fields(rows, time_remedy=remedy)
    if drop_copies:
        try:
            fields = without_copies(fields)
        except InputError as error:
            raise error.at(str(file)) from None
    if dropped:
        fields["metadata"] = {**fields.get("metadata", {}), NOTE: dropped}
    return _recording(file, of_joint(fields, one, ratio, side), _named(file, fields, name, one))


def _one_run(contents: Contents) -> tuple[str | Action, ...]:
    """Return remedies for stamps that go back: read one of several runs, or sort."""
    from jointid.recording.runs import one_run

    return one_run(contents) or (_SORT,)


@reads_open_files
def load_runs(
    path: Source,
    *,
    by: str | int,
    joint: str | int | None = None,
    columns: Mapping[str, str | int | None] | None = None,
    units: Mapping[str, str] | None = None,
    scale: Mapping[str, float] | None = None,
    extra: Collection[str] | Mapping[str, str | int] | None = None,
    gear_ratio: float | None = None,
    side: Mapping[str, str] | None = None,
    sample_period: float | None = None,
    kind: Kind | None = None,
    torque_hold: TorqueHold | None = None,
    name: str | None = None,
    topic: str | None = None,
    group: str | None = None,
    unpacked: int | None = None,
) -> tuple[Recording, ...]:
    """Return the recordings of a file with several consecutive runs.

    Parameters
    ----------
    path : path-like
        Same as in `load`.
    by : str or int
        Header or 0-based number of the column that identifies the runs: rows with the same value are
        one run.
    joint, columns, units, scale, extra, gear_ratio, side, sample_period, kind, torque_hold, topic, group, unpacked
        Same as in `load`.
    name : str, optional
        Prefix of the runs' names. Default: the name as in `load`.

    Returns
    -------
    tuple of Recording
        The runs in the order of first appearance of the values of `by`, named ``"NAME BY=VALUE"``.

    Raises
    ------
    InputError
        Same errors as `load`; the place names the run.

    Examples
    --------
    >>> slow, fast = jid.load("week.csv", by="run")
    """
    file = require_path("path", path)
    table = table_of(file, topic=topic, group=group, kind=kind, unpacked=unpacked)
    table, columns = as_stated(table, sample_period, columns)
    one = joint_of_table(table, joint, columns, extra)
    ratio = _ratio(one, gear_ratio)
    contents = read_contents(
        one.table,
        columns=one.columns,
        units=units,
        scale=scale,
        extra=one.extra,
        kind=kind,
        torque_hold=torque_hold,
    )
    header = contents.table.headers[column_index(contents.table, by, "by")]
    runs = []
    for value, rows in contents.rows_of(by).items():
        run = f"{header}={value}"
        try:
            fields = of_joint(contents.fields(rows), one, ratio, side)
            runs.append(
                _recording(file, fields, f"{_named(file, fields, name, one)} {run}".lstrip())
            )
        except InputError as error:
            raise InputError(
                error.reason,
                argument=error.argument,
                value=error.value,
                place=f"{error.place} ({run})",
                remedy=error.remedy,
            ) from None
    return tuple(runs)


def table_of(
    file: Path,
    *,
    topic: str | None = None,
    group: str | None = None,
    kind: str | None = None,
    unpacked: int | None = None,
) -> Table:
    """Return a file as a table of columns; the ending of its name selects the reader."""
    reader = reader_of(file)
    part: str | None = None
    for argument, given in (("topic", topic), ("group", group)):
        if given is None:
            continue
        if argument != reader.part or not isinstance(given, str):
            problem = "a name is expected" if argument == reader.part else _without(file, argument)
            raise InputError(problem, argument=argument, value=given, place=str(file))
        part = given
    if kind is not None:
        check_kind(kind)
    try:
        with allowing(unpacked):
            table = reader.open(file, part=part, kind=kind) if reader.part else reader.open(file)
            table = with_list_columns(table)
            if any(header.startswith("observation.state") for header in table.headers):
                from jointid.recording.readers.lerobot import with_episodes

                table = with_episodes(table, file)
    except FileNotFoundError:
        raise InputError(
            "there is no such file", place=str(file), remedy="check the path"
        ) from None
    except IsADirectoryError:
        raise InputError("this is a folder; a file name is expected", place=str(file)) from None
    except OSError as error:
        raise InputError(f"the file cannot be read ({error.strerror})", place=str(file)) from None
    except ModuleNotFoundError as error:
        package = (error.name or "").partition(".")[0]
        if package not in reader.packages:
            raise
        raise InputError(
            f"reading {_form(file, reader)} needs {package}, which is not installed",
            place=str(file),
            remedy=(f"pip install {reader.install or package}", "save the file as .csv"),
        ) from None
    if len(table.headers) > MOST_COLUMNS:
        raise InputError(
            f"it has {len(table.headers)} columns; at most {MOST_COLUMNS} are read",
            place=str(file),
        )
    return table


def _without(file: Path, argument: str) -> str:
    return f"{ending_of(file, reader_of(file).endings) if file.is_file() else 'such'} files have no {argument}"


def _form(file: Path, reader: Reader) -> str:
    if file.is_dir():
        return "bags" if reader.folder else "LeRobot datasets"
    return f"{ending_of(file, reader.endings)} files"


def file_name(file: Path, fields: Mapping[str, Any], name: str | None) -> Any:
    """Return a recording's name: from the call, from the saved recording, or the file name without its ending."""
    stem = (
        file.resolve().name
        if file.is_dir()
        else file.name[: -len(ending_of(file, reader_of(file).endings))]
    )
    # Bytes of a file name that are not UTF-8 become surrogates in Python, and these cannot be saved.
    stem = re.sub(_SURROGATE, "\ufffd", stem)
    return fields.get("name", stem) if name is None else name


def _named(file: Path, fields: Mapping[str, Any], name: str | None, one: OneJoint) -> Any:
    """Return the name of a recording; for one of several joints with the joint's name."""
    whole = file_name(file, fields, name)
    return f"{whole} joint {one.joint}".lstrip() if one.joint and name is None else whole


def _ratio(one: OneJoint, gear_ratio: float | None) -> float | None:
    if gear_ratio is None:
        return one.gear_ratio
    from jointid.recording.sides import checked_ratio

    return checked_ratio(gear_ratio)


def _recording(file: Path, fields: Mapping[str, Any], name: str | None) -> Recording:
    try:
        return Recording(**{**fields, "name": file_name(file, fields, name)})
    except InputError as error:
        raise error.at(str(file)) from None
