"""`load`: read the recordings in files, of a joint, a servo, several joints or a robot."""

from __future__ import annotations

import os
from collections.abc import Callable, Collection, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypedDict, Unpack, overload

from jointid.base.errors import InputError
from jointid.joint.joint import Joint
from jointid.recording.extra import named_extra
from jointid.recording.readers import loading
from jointid.recording.readers.folders import files_of
from jointid.recording.readers.loading_robot import load_robot
from jointid.recording.readers.open_files import Source, is_open, reads_open_files
from jointid.recording.recording import Recording
from jointid.recording.sides import MOTOR
from jointid.recording.signals import FloatArray, Kind, TorqueHold
from jointid.recording.wide.robot_recording import RobotRecording
from jointid.verbs.result_kinds import class_of_kind
from jointid.verbs.servo_log import servo_columns
from jointid.verbs.signatures import shows
from jointid.verbs.subjects import ask, check_options, is_robot, keywords

if TYPE_CHECKING:
    from jointid.robot.links.robot import Robot


class LoadOptions(TypedDict, total=False):
    """Options for any file."""

    columns: Mapping[str, str | int | None] | None
    units: Mapping[str, str] | None
    scale: Mapping[str, float] | None
    extra: Collection[str] | Mapping[str, str | int] | None
    side: Mapping[str, str] | None
    sample_period: float | None
    kind: Kind | None
    torque_hold: TorqueHold | None
    name: str | None
    topic: str | None
    group: str | None
    unpacked: int | None


class RunOptions(LoadOptions, total=False):
    """Options for a file of one joint."""

    joint: str | int | None
    gear_ratio: float | None


class OneRunOptions(RunOptions, total=False):
    """Options for a file of one run."""

    where: Mapping[str, float | str] | None
    drop_copies: bool
    drop_invalid: bool


class RobotFileOptions(LoadOptions, total=False):
    """Options for a file of several joints."""

    gear_ratio: Sequence[float] | FloatArray | float | None
    where: Mapping[str, float | str] | None
    drop_invalid: bool


@overload
def load(
    path: Source, subject: Joint | None = None, **options: Unpack[OneRunOptions]
) -> Recording: ...


@overload
def load(
    path: Source | Sequence[Source],
    subject: Joint | None = None,
    *,
    by: str | int,
    **options: Unpack[RunOptions],
) -> tuple[Recording, ...]: ...


@overload
def load(
    path: list[Any] | tuple[Any, ...],
    subject: Joint | None = None,
    **options: Unpack[OneRunOptions],
) -> tuple[Recording, ...]: ...


@overload
def load(
    path: Source,
    subject: Robot | None = None,
    *,
    joints: Sequence[str | int] | str,
    **options: Unpack[RobotFileOptions],
) -> RobotRecording: ...


@overload
def load(path: Source, subject: Robot, **options: Unpack[RobotFileOptions]) -> RobotRecording: ...


@overload
def load(
    path: list[Any] | tuple[Any, ...],
    subject: Robot | None = None,
    *,
    joints: Sequence[str | int] | str,
    **options: Unpack[RobotFileOptions],
) -> tuple[RobotRecording, ...]: ...


@shows(loading.load, others={"joints": None, "by": None})
def load(path: Any, subject: Any = None, **of_other_subjects: Any) -> Any:
    """Return the recording of one joint, of several joints, or of several runs from a file.

    A header consists of a signal's name and its unit, in upper or lower case: ``position_rad``, ``velocity [deg/s]``,
    ``torque_Nm``, ``time_ms``. Known names are time (t), position (pos, angle, q), velocity (vel, speed), torque
    (tau, force, motor_force, motor_torque_output, output_torque), sensor (sensor_raw, torque_sensor), reference
    (position_ref, position_reference, goal_position), link_position, temperature, motor_torque and current
    (motor_current). Headers of common controllers are also known: ``timestamp``, ``actual_q_0``, ``Axis 1.ActPos``,
    ``joint1_pos``, ``effort``. A commanded signal is never read as a measurement. A signal without a unit is assumed
    to be in SI units; ``metadata["assumed_units"]`` lists it. If the size or the steps of the time stamps show
    another unit, this unit is used (``metadata["recognised_units"]``). An unreadable column of an optional signal is
    omitted; ``metadata["left_out"]`` states the reason. `docs/logs.md` lists all rules.

    Parameters
    ----------
    path : path-like, open file, or list of these
        Name of a file, or a file or buffer that is open for reading (``io.StringIO``, ``io.BytesIO``). If a buffer has
        no name, its first bytes show the format.

        Text files (``.csv``, ``.csv.gz``, ``.txt``, ``.tsv``, ``.log``, ``.dat``) and ``.npz`` files come from any
        program or from `Recording.save`. MATLAB files (``.mat``) hold vectors, which may be in a struct; version 7.3
        needs h5py. ``.parquet`` files need pyarrow. HDF5 files (``.h5``, ``.hdf5``) need h5py. Logs of ROS messages
        need the extra ``ros``: ``.mcap``, a ROS 2 bag (its folder or one of its ``.db3`` files), or a ROS 1 ``.bag``.
        A ``.json`` file holds a list of records or is written by WPILib's SysId. ``.wpilog`` files need the extra
        ``wpilib``. A LeRobot dataset (version 2 or 3, needs pyarrow) is read from its folder or from one of its
        ``.parquet`` files.

        Commas, semicolons, tabs or blanks separate the cells of a text file. If commas do not separate cells, a comma
        may be the decimal point. Exports of TwinCAT Scope are also read. Several files, or a folder of files, are
        several runs.
    subject : Joint or Robot, optional
        The joint or robot of the recording. The gear ratio of a joint converts motor columns to the joint's side. For
        a servo, the columns that its `voltage` names are kept as `extra`. For a robot, all joints are read. Default:
        not known.
    joint : str or int, optional
        Number or name of the joint to read from a file with several joints. The headers contain this number or name:
        ``motor_position_3_rad``, ``joint3_pos``, ``q3``, ``q[2]``, ``position.3``, ``elbow.position [rad]``,
        ``elbow_position``. Columns without a joint, such as time, belong to all joints. `docs/several_joints.md`
        lists all rules. Default: the only joint.
    joints : sequence of str or int, or "all", optional
        The joints to read from a file with several joints on one clock; the result is a `RobotRecording`. Default:
        one joint.
    by : str or int, optional
        Header or 0-based number of the column with the number of the run. Rows with the same value are one run with
        the name ``"NAME BY=VALUE"``. Default: the file holds one run.
    columns : mapping of str to str, int or None, optional
        Signal → header or 0-based number of its column. None omits the signal; an omitted velocity is derived from
        position. ``{joint}`` in a header is replaced by the name or number of the joint:
        ``{"position": "enc_{joint}_rad"}``. ``{"position": "1:6"}`` means the columns of six joints: the 0-based
        numbers of the first and the last. Default: the headers show the columns. The headers also show the columns of
        signals without an entry.
    units : mapping of str to str, optional
        Signal → unit, e.g. ``{"position": "deg"}``. This unit overrides the header. Default: the header's unit.
    scale : mapping of str to float, optional
        Signal → factor from file units to SI units. This factor overrides the header. Use it for encoder counts
        (``{"position": 2 * math.pi / 4096}``), for a voltage with a known force per volt, or to change a sign.
        ``metadata["scale"]`` contains the factors. Default: the factor of the unit.
    extra : collection of str or mapping of str to str or int, optional
        Columns to keep as `Recording.extra`: headers, which are also the names, or a mapping of name → header or
        0-based number. A known unit at the end of a header (``_rad_s``, ``[kNm]``, ``_kgm2``) is converted to SI;
        values without a unit do not change. Every cell must be a finite number. Default: no columns; for a saved
        recording, its own extra columns.
    gear_ratio : float, or sequence of float, optional
        Motor angle per joint angle, negative if motor and joint turn in opposite directions. Motor columns
        (``motor_position_3_rad``, ``motor_torque_3_Nm``) are converted to the joint's side. For several joints, one
        value per joint. Default: the gear ratio of the subject. Without a gear ratio, motor columns are not
        converted, and ``metadata["side"]`` is "motor".
    side : mapping of str to str, optional
        Signal → "motor" or "joint". Use this option if the header of a position, velocity, reference or torque shows
        the wrong side of the gear. Example: ``{"velocity": "motor"}`` with the joint's position and `gear_ratio`.
        Default: the side in the headers, if they name joints; otherwise "joint".
    sample_period : float, optional
        Time between rows [s], if this time is constant. Time stamps in the file are then ignored. Default: the time
        column decides.
    where : mapping of str to number or str, optional
        Header of a column → value. Only rows with this value in the column are kept. Default: all rows.
    kind : {"revolute", "prismatic"}, optional
        Kind of the joint. Default: the units decide: ``"prismatic"`` for metres or newtons, otherwise ``"revolute"``.
    torque_hold : {"zoh", "linear"}, optional
        Torque between samples: constant (zero-order hold) or linear. Default: the saved value, otherwise not known.
    drop_copies : bool
        Whether to omit rows that repeat all measured signals of the previous row. A logger that is faster than the bus
        of the drive writes such rows. A standstill of more than ten rows is kept. Default False.
    drop_invalid : bool
        Whether to omit single damaged rows, at most a tenth of all rows. A row is damaged if a value is missing, not
        a number, not finite or above 1e15. ``metadata["dropped_rows"]`` is the number of omitted rows. Longer damaged
        stretches become gaps. For several joints, a row that is damaged in one joint is omitted in all joints.
        Default False.
    name : str, optional
        Name of the recording. Default: the saved name, otherwise the file's name without its ending.
    topic : str, optional
        Topic of the recording in a log of messages. Default: the only topic with joints.
    group : str, optional
        HDF5 or MATLAB 7.3 file: path of the group (struct) with the datasets of the recording. Default: the only
        group with such datasets.
    unpacked : int, optional
        Largest size of a compressed file after unpacking, in bytes. Default: 64 MB or 50 times the compressed size,
        whichever is larger. Larger files are refused. Each number counts 8 bytes. The numbers of a packed text may
        take 100 MB.

    Returns
    -------
    Recording, RobotRecording, or tuple of these
        The result is a tuple for several files, a folder or `by`. A `RobotRecording` is on the side of the gear that
        the headers show. If one joint has signals of both sides, all signals are converted to the joint's side with
        `gear_ratio`.

    Raises
    ------
    InputError
        The file cannot be read, its columns are not a recording, or an option does not apply. The error names the file,
        the line or the header, and the expected content.

    Examples
    --------
    >>> recording = jid.load("run.csv")
    >>> recording = jid.load("log.csv", columns={"position": "enc1"}, units={"position": "deg"})
    >>> recording = jid.load("robot.csv", extra={"gravity": "model_gravity_torque_1_Nm"})
    >>> buffered = jid.load(io.StringIO(Path("run.csv").read_text()))
    >>> slow, fast = jid.load("week.csv", by="run")
    >>> arm = jid.load("arm.csv", joints="all", gear_ratio=[32, 32, 45, -48, 45, 32])
    >>> elbow = jid.load("arm.csv", joint=3, gear_ratio=-48)
    >>> elbow = jid.load("arm.mcap", joint="elbow", topic="/joint_states")  # doctest: +SKIP
    """
    read = _reader(subject, of_other_subjects)
    several = isinstance(path, list | tuple)
    if several and not path:
        raise InputError("at least one file is expected", argument="path", value=path)
    if not several and (is_open(path) or files_of([path]) == [path]):
        return read(path)
    found: list[Any] = []
    for file in files_of(path if several else [path]):
        held = read(file)
        found += held if isinstance(held, tuple) else [held]
    return tuple(found)


def _reader(subject: object, options: dict[str, Any]) -> Callable[[Any], Any]:
    """Return the reader for a file of this subject."""
    joints = options.pop("joints", None)
    if is_robot(subject) or joints is not None:
        if isinstance(subject, Joint):
            raise InputError(
                "load of several joints cannot use a single Joint",
                argument="subject",
                value=subject,
            )
        word = "several joints"
        return lambda path: _said(ask, path, "load", word, load_robot, path, joints, **options)
    if subject is not None and not isinstance(subject, Joint):
        raise InputError(
            "a Joint or a Robot is expected",
            argument="subject",
            value=subject,
            remedy="give several files as a list",
        )
    function, word = loading.load, "a recording"
    if options.get("by") is None:
        options.pop("by", None)
    else:
        function, word = loading.load_runs, "several runs"  # type: ignore[assignment]
    check_options("load", word, options, keywords(function)[1:])
    if subject is None:
        return lambda path: _said(function, path, path, **options)
    return lambda path: _said(_of_joint, path, path, function, subject, options)


@reads_open_files
def _of_joint(
    path: Any, function: Callable[..., Any], joint: Joint, options: dict[str, Any]
) -> Any:
    """Read a joint's file, including the columns of a servo, and convert columns of the motor with the gear ratio."""
    if joint.voltage is not None:
        parts = {name: options.get(name) for name in ("topic", "group", "unpacked")}
        stated = named_extra(options.get("extra"))
        options = options | {"extra": servo_columns(path, joint.voltage, stated, **parts)}
    ratio = {} if joint.gear_ratio == 1.0 else {"gear_ratio": joint.gear_ratio}
    try:
        found = function(path, **options)
    except InputError as error:
        if error.argument != "gear_ratio" or not ratio or "gear_ratio" in options:
            raise
        return function(path, **ratio, **options)
    first = found if isinstance(found, Recording) else found[0]
    if first.metadata.get("side") != MOTOR or not ratio or "gear_ratio" in options:
        return found
    return function(path, **ratio, **options)


def _said(function: Callable[..., Any], source: object, *arguments: Any, **options: Any) -> Any:
    """Call the reader of a source; name the type of a jointid file that is not a recording."""
    try:
        return function(*arguments, **options)
    except InputError:
        if isinstance(source, str | os.PathLike) and (what := _of_ours(Path(source))):
            reader = "Joint" if what == "a joint" else "Result"
            raise InputError(
                f"this is a file of {what}, not a recording",
                place=os.fspath(source),
                remedy=f"jid.{reader}.load(path) reads it",
            ) from None
        raise


def _of_ours(path: Path) -> str:
    """Return the content of a jointid file that is not a recording; empty for any other file."""
    try:
        return f"a result ({class_of_kind(path)._KIND})"
    except InputError:
        return "a joint" if path.suffix == ".toml" and path.is_file() else ""
