"""Files with motions: a table `[trajectory]`, written by a design or by hand."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from jointid.base.argument_checks import require_path
from jointid.base.errors import InputError
from jointid.base.schema import Kind, ListOf, Number, Plain, Record, TableOf, Text
from jointid.base.toml_file import read_toml
from jointid.base.values import dataclass
from jointid.joint.angles import in_radians
from jointid.joint.joint import Joint
from jointid.joint.joint_file import joint_from_document
from jointid.simulation.designed_for import DesignedFor
from jointid.simulation.peaks import Peaks
from jointid.simulation.setting_tables import read_controller
from jointid.simulation.trajectory import Trajectory

SCHEMA = 1
"""Schema of a design's file. It increases when a reader of the earlier format would misread the new one."""

_SINES = "sines"
_FORMS = (_SINES, "thesis", "sine", "multisine", "sigmoid", "step", "trapezoid")
_MOST_SINES = 10_000
_LISTS = ("amplitude", "frequency", "phase")
# Types of a trajectory and of a magnitude; the trajectory checks its values.
_VALUE, _SIZE = Number(), Number(low=0.0)
_DURATION = Number(low=1e-3, high=1e6)  # [s]
_PEAKS = Record(
    {
        "position": ListOf(_VALUE, 2, 2),
        **dict.fromkeys(("velocity", "acceleration", "torque"), _SIZE),
    },
    {"sensor_torque": _SIZE},
)
_PERIOD = Number(low=1e-6, high=1.0)  # [s]
# A table [design] shows that a design wrote the file. Then the file has the joint and the controller, too.
_ABOUT = Record({"control_period": _PERIOD}, other=Plain())
_DESIGNED = Record(
    {"design": _ABOUT, "joint": Plain(), "controller": Plain()},
    {"believed": TableOf(ListOf(_VALUE, 2, 2), 1000)},
    other=Plain(),
)
_TRAJECTORY = Record({"form": Text(known=_FORMS)}, other=Plain())
_FILE = Record({"trajectory": Plain()}, {"peaks": _PEAKS}, other=Plain())

COMMENTS = {
    "trajectory.amplitude": "rad, or m of a prismatic joint",
    "trajectory.frequency": "rad/s",
    "trajectory.phase": "rad",
    "trajectory.offset": "position at the start and at the end",
    "trajectory.fade": "s, in which the sines grow at the start and fade at the end",
    "trajectory.duration": "s",
}
"""Comments in a file after the keys of a motion."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Motion:
    """The content of a motion's file."""

    trajectory: Trajectory
    peaks: Peaks | None = None  # values that the design's joints reach; None: not in the file
    designed_for: DesignedFor | None = None  # None for a motion that was written by hand


def load_motion(path: str | Path) -> Motion:
    """Return the motion in a file, such as `Design.save` writes. A table `[trajectory]` is enough.

    Its `form` is a class method of `Trajectory`, and the other keys are its arguments. Angles may be texts
    such as "60deg".
    """
    place = require_path("path", path)
    try:
        return motion_of(read_toml(place), place.name)
    except InputError as error:
        raise (error if error.place.startswith(str(place)) else error.at(str(place))) from None


def motion_of(document: Mapping[str, Any], source: str = "the motion") -> Motion:
    """Return the motion in a file's tables. `source` is the file's name, for later messages."""
    if "trajectory" in document:  # otherwise it is another file, such as a joint's
        check_schema(document)
    tables = _FILE.read(dict(document), "")
    peaks = tables.get("peaks")
    trajectory = _trajectory(tables["trajectory"])
    return Motion(
        trajectory=trajectory,
        peaks=None if peaks is None else Peaks(**peaks | {"position": tuple(peaks["position"])}),
        designed_for=_designed_for(tables, trajectory, source) if "design" in tables else None,
    )


def check_schema(document: Mapping[str, Any]) -> None:
    """Refuse the file of a later jointid. A file that was written by hand has no schema."""
    schema = document.get("schema")
    if isinstance(schema, int) and not isinstance(schema, bool) and schema > SCHEMA:
        raise InputError(
            f"this version of jointid reads schemas up to {SCHEMA}",
            argument="schema",
            value=schema,
            remedy="update jointid",
        )


def believed_of(tables: Mapping[str, Any]) -> dict[str, tuple[float, float]]:
    """Return the ranges of a table `[believed]`, if there is one."""
    found = {name: (low, high) for name, (low, high) in tables.get("believed", {}).items()}
    for name, (low, high) in found.items():
        if low > high:
            raise InputError(
                "the first value must not be above the second",
                value=[low, high],
                place=f"believed.{name}",
            )
    return found


def motion_table(trajectory: Trajectory) -> dict[str, Any]:
    """Return the table `[trajectory]` of a motion that is a sum of sines; the inverse of `motion_of`."""
    if trajectory.form != "multisine":
        raise InputError(
            "a sum of sines is expected", argument="trajectory.form", value=trajectory.form
        )
    arguments = {
        name: list(value) if isinstance(value, tuple) else value
        for name, value in trajectory.arguments
    }
    return {"form": _SINES, **arguments}


def _designed_for(tables: Mapping[str, Any], trajectory: Trajectory, source: str) -> DesignedFor:
    read = _DESIGNED.read(dict(tables), "")
    return DesignedFor(
        source=source,
        trajectory=trajectory,
        joint=joint_from_document(TableOf(Plain()).read(read["joint"], "joint"), "[joint]", Joint),
        controller=read_controller(read["controller"], "controller"),
        control_period=read["design"]["control_period"],
        believed=believed_of(read),
    )


def _trajectory(table: Any) -> Trajectory:
    """Return the trajectory of a table: call the form's class method with the other keys."""
    given = {key: in_radians(value) for key, value in _TRAJECTORY.read(table, "trajectory").items()}
    form = given.pop("form")
    make: Callable[..., Trajectory] = getattr(Trajectory, form)
    required: dict[str, Kind] = {}
    optional: dict[str, Kind] = {}
    for name, parameter in inspect.signature(make).parameters.items():
        kind: Kind = _VALUE
        if name == "duration":
            kind = _DURATION
        elif name == "count":
            kind = Number(low=1, high=_MOST_SINES, whole=True)
        elif form == _SINES and name in _LISTS:
            kind = ListOf(_VALUE, 1, _MOST_SINES)
        (required if parameter.default is parameter.empty else optional)[name] = kind
    arguments = Record(required, optional).read(given, "trajectory")
    try:
        return make(**arguments)
    except InputError as error:
        name = error.argument.removeprefix("Trajectory").removeprefix(".")
        place = f"trajectory.{name}" if name else "trajectory"
        raise InputError(
            error.reason, value=error.value, place=place, remedy=error.remedy
        ) from None
