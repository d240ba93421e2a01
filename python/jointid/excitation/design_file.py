"""Read a design's tables: its motion, its assumptions, and its expected errors."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, TypeVar

from jointid.base.errors import InputError
from jointid.base.schema import ListOf, Number, Plain, Record, TableOf, Text
from jointid.excitation.design_fields import CRITERIA, DesignFields
from jointid.excitation.expected_error import ExpectedError
from jointid.excitation.motion_limits import MotionLimits
from jointid.joint.joint import Joint
from jointid.joint.joint_file import joint_from_document
from jointid.simulation.motion_file import (
    believed_of,
    check_schema,
    motion_of,
)
from jointid.simulation.setting_tables import (
    read_controller,
    read_sensors,
)

Saved = TypeVar("Saved", bound=DesignFields)

_SIZE, _ERROR = Number(low=0.0), Number(low=0.0, infinite=True)
_COUNT = Number(low=0, high=2**63 - 1, whole=True)  # range of TOML's whole numbers
_DESIGN = Record(
    {
        **dict.fromkeys(("status", "weakest", "limited_by"), Text()),
        "criterion": Text(known=CRITERIA),
        **dict.fromkeys(("joints", "evaluations"), _COUNT),
        "seed": Number(low=0, high=2**64 - 1, whole=True),
        "control_period": Number(low=1e-6, high=1.0),
        "jointid": Text(),
    },
    {"reason": Text()},
)
_LIMITS = Record(
    {"position": ListOf(Number(), 2, 2), "velocity": _SIZE},
    dict.fromkeys(("acceleration", "torque", "sensor_range"), _SIZE),
)
_EXPECTED = Record(
    {
        "unit": Text(longest=100),
        "value": Number(),
        **dict.fromkeys(("stderr", "relative", "worst"), _ERROR),
    },
    {"before": _ERROR},
)
_FILE = Record(
    {
        "schema": Number(low=1, whole=True),
        "design": _DESIGN,
        "trajectory": Plain(),  # read as in any motion's file
        "peaks": Plain(),
        "limits": _LIMITS,
        "expected": TableOf(_EXPECTED, 1000),
        "controller": Plain(),
        "sensors": Plain(),
        "joint": Plain(),
    },
    {
        "reference": TableOf(_ERROR, 1000),
        "believed": TableOf(ListOf(Number(), 2, 2), 1000),
    },
)


def read_design(document: Mapping[str, Any], cls: type[Saved], place: str = "") -> Saved:
    """Return the design of this class in the tables of a file; `place` is the file.

    Raises
    ------
    InputError
        The tables are not a design. The message names the key.
    """
    if "design" not in document and "trajectory" in document:
        raise InputError("this motion has no table [design] with the expected errors")
    check_schema(document)
    tables = _FILE.read(dict(document), "")
    motion = motion_of({name: tables[name] for name in ("trajectory", "peaks")})
    assert motion.peaks is not None  # required by the schema
    expected = {name: ExpectedError(name=name, **each) for name, each in tables["expected"].items()}
    about = tables["design"]
    del about["jointid"]
    if about["weakest"] not in expected:
        raise InputError(
            "one of the parameters in [expected] is expected",
            value=about["weakest"],
            place="design.weakest",
        )
    return cls(
        **about,
        trajectory=motion.trajectory,
        duration=motion.trajectory.duration,
        joint=joint_from_document(
            TableOf(Plain()).read(tables["joint"], "joint"),
            f"{place}: [joint]" if place else "joint",
            Joint,
        ),
        controller=read_controller(tables["controller"], "controller"),
        sensors=read_sensors(tables["sensors"], "sensors"),
        limits=MotionLimits(**tables["limits"]),
        peaks=motion.peaks,
        parameters=expected,
        reference=tables.get("reference", {}),
        believed=believed_of(tables),
    )
