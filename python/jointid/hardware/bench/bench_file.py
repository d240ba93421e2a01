"""Bench files: a joint file's table `[session]`, read with its place in every complaint."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping
from dataclasses import fields
from pathlib import Path
from typing import Any, TypeVar

from jointid import _core
from jointid.base.errors import InputError
from jointid.hardware.bench.bench import Bench, BusOptions, Emulation, joint_with_truth
from jointid.hardware.elmo.options import ElmoOptions
from jointid.hardware.elmo.torque_source import AnalogInput, SensorScaling, SyncedConverter
from jointid.hardware.session.limits import SessionLimits
from jointid.hardware.session.options import SessionOptions
from jointid.hardware.session.realtime import RealTimeOptions
from jointid.joint.checks import suggestion
from jointid.joint.joint import Joint
from jointid.joint.joint_file import joint_from_document, read_document
from jointid.simulation.arguments import Controller
from jointid.simulation.scenario import believing
from jointid.simulation.trajectory import Trajectory

_TABLES = ("bus", "drive", "torque", "trajectory", "controller", "limits", "real_time", "emulated")
_TRAJECTORIES = ("thesis", "sine", "multisine", "sigmoid", "step", "trapezoid")
_LAWS = {
    "adaptive_robust": _core.AdaptiveRobust,
    "compensated_pid": _core.CompensatedPid,
    "lugre_observer": _core.LugreObserver,
    "pid": _core.Pid,
    "pd": _core.Pd,
}
_SOURCES: dict[str, type | None] = {
    "converter": SyncedConverter,
    "analog": AnalogInput,
    "none": None,
}
# Of the emulated sensor, these are the encoder's and the converter's own business.
_NOT_EMULATED = {"encoder_counts", "velocity", "velocity_counts", "velocity_time"}
_NOT_EMULATED |= {"converter_bits", "converter_range", "converter_noise", "converter_samples"}
_KINDS: dict[str, tuple[tuple[type, ...], str]] = {
    "float": ((int, float), "a number"),
    "int": ((int,), "a whole number"),
    "str": ((str,), "a text"),
    "bool": ((bool,), "true or false"),
    "tuple[int, ...]": ((list,), "a list of whole numbers"),
    "tuple[float, float]": ((list,), "a list of two numbers"),
}
Made = TypeVar("Made")


def load_bench(path: str | Path) -> Bench:
    """Read a bench file: see `Bench.load`."""
    place = str(path)
    document = read_document(path)
    joint = joint_from_document(document, place)
    if "session" not in document:
        raise InputError(
            f"{place}: there is no table [session], which says how the joint is reached and moved; "
            "docs/hardware.md shows one"
        )
    session = _Table(document["session"], "session", place)
    inner = {name: session.table(name) for name in _TABLES}
    for name, told in (("trajectory", "where the joint goes"), ("controller", "what moves it")):
        if name not in session.entries:
            raise InputError(f"{place}: there is no table [session.{name}], which says {told}")
    if "gear_ratio" not in document.get("drive", {}):
        raise InputError(f"{place}: [drive] has no gear_ratio; 1 where there is no gear")
    resolution = 2.0 * math.pi / abs(joint.gear_ratio)
    bus = inner["bus"].make(BusOptions)
    source = _torque(inner["torque"])
    drive = inner["drive"].make(ElmoOptions, torque=source, bitrate=float(bus.bitrate))
    options = session.make(SessionOptions, resolution=resolution / drive.counts_per_turn)
    return Bench(
        joint=joint,
        controller=_controller(inner["controller"], joint),
        trajectory=_trajectory(inner["trajectory"]),
        drive=drive,
        limits=inner["limits"].call(
            lambda **given: SessionLimits.of(joint, **given),
            _types(SessionLimits),
        ),
        options=options,
        bus=bus,
        real_time=inner["real_time"].make(RealTimeOptions),
        emulation=_emulation(inner["emulated"], joint) if "emulated" in session.entries else None,
    )


class _Table:
    """A table of the file; what it makes complains with its place."""

    def __init__(self, entries: object, place: str, source: str) -> None:
        if not isinstance(entries, Mapping):
            raise InputError(f"{source}: {place} is {entries!r}; a table [{place}] is expected")
        self.entries = {str(name): _angle(value) for name, value in entries.items()}
        self.place, self.source = place, source

    def table(self, name: str) -> _Table:
        return _Table(self.entries.get(name, {}), f"{self.place}.{name}", self.source)

    def word(self, name: str, default: str, known: Mapping[str, Any] | tuple[str, ...]) -> str:
        word = self.entries.get(name, default)
        if not isinstance(word, str) or word not in known:
            self.refuse(f"{name} is {word!r}; {suggestion(word, [*known])}")
        return str(word)

    def make(self, kind: Callable[..., Made], **given: Any) -> Made:
        """A value of options, from the entries that are no tables."""
        known = {name: type_ for name, type_ in _types(kind).items() if name not in given}
        return self.call(kind, known, **given)

    def call(self, kind: Callable[..., Made], known: Mapping[str, str], **given: Any) -> Made:
        """What `kind` returns for the entries; `known` has their types, "" if it checks them."""
        entries = {n: v for n, v in self.entries.items() if not isinstance(v, Mapping)}
        tables = [n for n, v in self.entries.items() if isinstance(v, Mapping)]
        for name in [*entries, *tables]:
            if name not in known and not (name in tables and self.place == "session"):
                self.refuse(f"{name!r} is unknown; {suggestion(name, known)}")
            if name in tables and self.place == "session" and name not in _TABLES:
                self.refuse(f"{name!r} is unknown; {suggestion(name, _TABLES)}")
        for name, value in entries.items():
            self.check(name, value, known[name])
            if isinstance(value, list):
                entries[name] = tuple(value)
        try:
            return kind(**entries, **given)
        except (ValueError, TypeError) as error:
            reason = re.sub(r"^[A-Z]\w+: ", "", str(error))
            raise InputError(f"{self.source}: [{self.place}] {reason}") from error

    def check(self, name: str, value: object, type_: str) -> None:
        wanted = _KINDS.get(type_.removesuffix(" | None"))
        right = wanted is None or isinstance(value, wanted[0])
        if wanted is not None and (
            not right or (isinstance(value, bool) and bool not in wanted[0])
        ):
            self.refuse(f"{name} is {value!r}; {wanted[1]} is expected")

    def without(self, *names: str) -> _Table:
        left = {name: value for name, value in self.entries.items() if name not in names}
        return _Table(left, self.place, self.source)

    def refuse(self, told: str) -> None:
        raise InputError(f"{self.source}: [{self.place}] {told}")


def _types(kind: Any) -> dict[str, str]:
    return {item.name: str(item.type) for item in fields(kind)}


def _angle(value: Any) -> Any:
    """Angles may be written as "60deg"."""
    if isinstance(value, str) and value.endswith("deg"):
        try:
            return math.radians(float(value.removesuffix("deg")))
        except ValueError:
            return value
    if isinstance(value, list):
        return [_angle(entry) for entry in value]
    return value


def _torque(table: _Table) -> SyncedConverter | AnalogInput | None:
    kind = _SOURCES[table.word("source", "converter", _SOURCES)]
    scale = {item.name for item in fields(SensorScaling)}
    scaling = _Table(
        {n: v for n, v in table.entries.items() if n in scale}, table.place, table.source
    ).make(SensorScaling)
    rest = table.without("source", *scale)
    if kind is None:
        for name in table.without("source").entries:
            table.refuse(f"{name!r} is given, but the source is 'none'")
        return None
    made: SyncedConverter | AnalogInput = rest.make(kind, scaling=scaling)
    return made


def _trajectory(table: _Table) -> Trajectory:
    form = table.word("form", "thesis", _TRAJECTORIES)
    entries = table.without("form").entries
    try:
        trajectory: Trajectory = getattr(Trajectory, form)(**entries)
    except (ValueError, TypeError) as error:
        reason = str(error).replace("Trajectory.", "").replace("keyword argument", "option")
        raise InputError(f"{table.source}: [{table.place}] {reason}") from error
    return trajectory


def _controller(table: _Table, joint: Joint) -> Controller:
    law = _LAWS[table.word("law", "adaptive_robust", _LAWS)]
    given = table.without("law")
    names = dict.fromkeys(law().asdict(), "")
    controller: Controller = given.call(law, names)
    if "coulomb" not in names:
        return controller
    # What the joint file says of the joint, unless this table says otherwise.
    try:
        controller = believing(controller, joint)
    except InputError as error:
        raise InputError(f"{table.source}: {error}") from error
    believed: Controller = controller.replace(**given.entries)
    return believed


def _emulation(table: _Table, joint: Joint) -> Emulation:
    truth, sensors = table.table("truth"), table.table("sensors")
    known = {name: "" for name in _core.Sensors().asdict() if name not in _NOT_EMULATED}
    for name, value in truth.entries.items():
        if isinstance(value, bool) or not isinstance(value, int | float):
            truth.refuse(f"{name} is {value!r}; a number is expected")
    try:
        joint_with_truth(joint, truth.entries)
    except InputError as error:
        raise InputError(f"{table.source}: [{truth.place}] {error}") from error
    return table.without("truth", "sensors").make(
        Emulation, truth=truth.entries, sensors=sensors.call(_core.Sensors, known)
    )
