"""Reader of bench files: the table `[session]` of a joint file. Each error names the place of the value."""

from __future__ import annotations

import inspect
from pathlib import Path
from typing import Any

from jointid import _core
from jointid.base.errors import InputError
from jointid.hardware.bench.bus_options import BusOptions
from jointid.hardware.bench.drive_format import DriveFormat
from jointid.hardware.bench.drive_types import DEFAULT_TYPE, adapter_of, drive_type_names
from jointid.hardware.bench.emulation import Emulation, joint_with_truth
from jointid.hardware.bench.first_motion_options import FirstMotionOptions
from jointid.hardware.bench.table import Table, type_name, types_of
from jointid.hardware.session.gains import with_fitting_gains
from jointid.hardware.session.limits import SessionLimits
from jointid.hardware.session.moving_joint import MovingJoint
from jointid.hardware.session.options import SessionOptions, check_cycles
from jointid.hardware.session.realtime import RealTimeOptions
from jointid.joint.angles import ANGLE_EXPECTED, text_in
from jointid.joint.checks import suggestion
from jointid.joint.joint import Joint
from jointid.joint.joint_file import joint_from_document, read_document
from jointid.simulation.arguments import LAWS, Controller
from jointid.simulation.motion_file import Motion, load_motion
from jointid.simulation.scenario import believing
from jointid.simulation.stepped import stepped_joint
from jointid.simulation.trajectory import Trajectory

_TABLES = (
    "bus",
    "drive",
    "trajectory",
    "controller",
    "limits",
    "real_time",
    "emulated",
    "first_motion",
)
_REQUIRED = {
    "trajectory": "which describes the motion",
    "controller": "which describes the controller",
}
_TRAJECTORIES = ("thesis", "sine", "multisine", "sigmoid", "step", "trapezoid")
_ANGLES = ("amplitude", "offset", "distance")  # keys of a trajectory
_LAWS = {name: law for name, law in LAWS.items() if law is not _core.OpenLoop}
# Attributes of the emulated sensor that belong to the drive's encoder and converter.
_NOT_EMULATED = {"encoder_counts", "velocity", "velocity_counts", "velocity_time"}
_NOT_EMULATED |= {"converter_bits", "converter_range", "converter_noise", "converter_samples"}
# Keys of [session.emulated] that belong to every type of drive.
_EMULATED = ("integration_step", "position")


def bench_fields(path: str | Path, *, with_motion: bool = True) -> dict[str, Any]:
    """Return the fields of the bench in a file; see `Bench.load`.

    Parameters
    ----------
    path : path
    with_motion : bool
        Whether to read the motion. False puts any motion in its place, for a program that makes it. Default True.
    """
    source = str(path)
    document = read_document(path)
    joint = joint_from_document(document, source, Joint)
    if "session" not in document:
        raise InputError(
            "the file has no table [session] for drive and motion; docs/hardware.md has an example",
            place=source,
        )
    session = Table(document["session"], "session", source)
    name = session.table("drive").choice("type", DEFAULT_TYPE, drive_type_names())
    adapter = adapter_of(name, DriveFormat)
    tables = (*_TABLES, *adapter.tables)
    for key, value in session.entries.items():
        if isinstance(value, dict) and key not in tables:
            session.refuse(key, f"unknown table; {suggestion(key, tables)}")
    for key, meaning in _REQUIRED.items():
        if key not in session.entries and (with_motion or key != "trajectory"):
            raise InputError(f"the file has no table [session.{key}], {meaning}", place=source)
    if "gear_ratio" not in document.get("drive", {}):
        raise InputError(
            "missing; state 1 for a joint without a gear",
            argument="gear_ratio",
            place=f"{source}: [drive]",
        )
    bus = session.table("bus").make(BusOptions)
    motion = Motion(trajectory=Trajectory.thesis())
    if with_motion:
        motion = _motion(session.table("trajectory"), Path(path).parent)
    trajectory = motion.trajectory
    options = session.without(*tables).make(SessionOptions, resolution=None)
    try:
        check_cycles("duration", trajectory.duration, options.period)
    except InputError as error:
        raise error.at(session.table("trajectory").place) from error
    limits = session.table("limits").call(
        lambda **given: SessionLimits.of(joint, **given), types_of(SessionLimits)
    )
    _check_peaks(session.table("trajectory"), motion, limits)
    return {
        "joint": joint,
        "controller": _controller(session.table("controller"), joint, options.period),
        "trajectory": trajectory,
        "drive": adapter.options(session, bus),
        "limits": limits,
        "options": options,
        "bus": bus,
        "real_time": session.table("real_time").make(RealTimeOptions),
        "emulation": _emulation(session.table("emulated"), joint, adapter)
        if "emulated" in session.entries
        else None,
        "drive_type": name,
        "first_motion": session.table("first_motion").make(FirstMotionOptions),
        "designed_for": motion.designed_for,
    }


def _motion(table: Table, folder: Path) -> Motion:
    """Return the motion from a file (relative to the bench file's folder), or from the keys of the table."""
    if "file" not in table.entries:
        return Motion(trajectory=_trajectory(table))
    name = table.entries["file"]
    if not isinstance(name, str):
        table.refuse("file", "the name of a motion file is expected", name)
    for other in table.entries:
        if other != "file":
            table.refuse(other, "the motion file already defines the whole motion; remove this key")
    try:
        return load_motion(folder / name)
    except InputError as error:
        raise error.at(table.place) from error


def _check_peaks(table: Table, motion: Motion, limits: SessionLimits) -> None:
    """Refuse a designed motion that exceeds the session's limits."""
    if motion.peaks is None:
        return
    beyond = limits.passed_by(motion.peaks)
    if beyond:
        table.refuse("file", f"in this motion joints go {beyond}", table.entries["file"])


def _trajectory(table: Table) -> Trajectory:
    form = table.choice("form", "thesis", _TRAJECTORIES)
    make = getattr(Trajectory, form)
    expected = inspect.signature(make).parameters
    arguments = table.without("form")
    arguments.check_names(expected)
    for name, parameter in expected.items():
        if parameter.default is parameter.empty and name not in arguments.entries:
            table.refuse(name, f"missing; the form {form!r} needs it")
    for name in _ANGLES:
        if (text := text_in(arguments.entries.get(name))) is not None:
            table.refuse(name, ANGLE_EXPECTED, text)
    trajectory: Trajectory = arguments.call(
        make, {name: type_name(parameter.annotation) for name, parameter in expected.items()}
    )
    return trajectory


def _controller(table: Table, joint: Joint, period: float) -> Controller:
    law = _LAWS[table.choice("law", "adaptive_robust", _LAWS)]
    gains = table.without("law")
    controller: Controller = gains.make_core(law)
    moved = MovingJoint.of(joint)
    if "coulomb" not in controller.asdict():
        return with_fitting_gains(controller, gains.entries, moved, period)
    # The joint file's parameters, unless this table has other values.
    try:
        controller = believing(controller, joint)
    except InputError as error:
        raise InputError(str(error), place=table.source) from error
    assumed: Controller = controller.replace(**gains.entries)
    return with_fitting_gains(assumed, gains.entries, moved, period)


def _emulation(table: Table, joint: Joint, adapter: DriveFormat) -> Emulation:
    truth, sensors = table.table("truth"), table.table("sensors")
    for name, value in truth.entries.items():
        if isinstance(value, bool) or not isinstance(value, int | float):
            truth.refuse(name, "a number is expected", value)
    try:
        true_joint = joint_with_truth(joint, truth.entries)
    except InputError as error:
        raise InputError(str(error), place=truth.place) from error
    _check_truth(truth, true_joint)
    common: dict[str, Any] = {n: v for n, v in table.entries.items() if n in _EMULATED}
    return Table(common, table.name, table.source).make(
        Emulation,
        truth=truth.entries,
        sensors=sensors.make_core(_core.Sensors, _NOT_EMULATED),
        drive=adapter.emulation(table.without("truth", "sensors", *_EMULATED)),
    )


def _check_truth(truth: Table, joint: Joint) -> None:
    """Refuse true values that no simulated joint can have. The emulation reports missing values."""
    try:
        stepped_joint(joint)
    except InputError as error:
        name = error.argument.removeprefix("joint.")
        if name in truth.entries:
            truth.refuse(name, error.reason, truth.entries[name])
