"""Read a robot's estimate from its JSON."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any, TypeVar

import numpy as np

from jointid.base.errors import InputError
from jointid.base.schema import Number
from jointid.estimate.json import (
    arrays_of,
    empty_calls,
    finding_of,
    matrix_of,
    parameter_of,
)
from jointid.estimate.statistics import ResidualStatistics
from jointid.problem.window_table import WindowTable
from jointid.robot.links.link_tree import LinkTree
from jointid.robot.links.models import is_asymmetric, terms_of
from jointid.robot.links.parameters import (
    DIFFERENCE,
    FRICTION,
    MOTOR_TERMS,
    PARAMETERS,
    POSITION_GAIN,
)
from jointid.robot.links.position_drive import PositionDrive
from jointid.robot.links.robot import Robot
from jointid.robot.motion.shifts import torque_lag, torque_shift
from jointid.robot.result.cross_check import Compared, CrossCheck
from jointid.robot.result.document import KIND, SCHEMA
from jointid.robot.result.json_schema import ROBOT_ESTIMATE
from jointid.robot.result.record import RobotEstimateRecord, RobotJoint

Saved = TypeVar("Saved", bound=RobotEstimateRecord)

_TURNED = 1e-6  # tolerance of a rotation matrix
_SINGULAR = 1e9


def robot_estimate_of(document: Any, cls: type[Saved]) -> Saved:
    """Return the estimate of this class that a document holds; see `RobotEstimate.from_json`."""
    if not isinstance(document, dict) or document.get("kind") != KIND:
        raise InputError(
            f"this JSON is not a robot's estimate: its field 'kind' is not '{KIND}'",
            remedy="identify a robot and save its estimate",
        )
    schema = int(Number(low=1, whole=True).read(document.get("schema"), "schema"))
    if schema != SCHEMA:
        old = "the file lacks the robot's links, and the estimate cannot be used without them"
        raise InputError(
            old if schema < SCHEMA else f"this version of jointid reads schemas up to {SCHEMA}",
            value=schema,
            place="schema",
            remedy="identify again" if schema < SCHEMA else "update jointid",
        )
    found = ROBOT_ESTIMATE.read(document, "")
    for place, reason in _contradictions(found):
        raise InputError(reason, place=place)
    return _estimate(found, cls)


def _estimate(d: Mapping[str, Any], cls: type[Saved]) -> Saved:
    base = [parameter_of(each) for each in d["base_parameters"]]
    robot = _robot(d["robot"], d["name"])
    try:
        shift = d["settings"].get("shift", {})
        torque_shift(shift, robot)
        torque_lag(shift, robot)
    except InputError as error:
        raise error.at("settings") from None
    return cls(
        joints={
            name: RobotJoint(
                name=name,
                model=each["model"],
                parameters={key: parameter_of(p) for key, p in each["parameters"].items()},
                residuals=ResidualStatistics(**each["residuals"]),
                windows=WindowTable(**arrays_of(each["windows"] or _NO_WINDOWS)),
            )
            for name, each in d["joints"].items()
        },
        inertia=d["inertia"],
        base_parameters={p.name: p for p in base},
        inertial=np.array(d["inertial"], dtype=np.float64),
        consistent=d["consistent"],
        impossible_by=d["impossible_by"],
        relative_residual=d["relative_residual"],
        within=d.get("within", {}),
        free=tuple(d["free"]),
        covariance=matrix_of(d["covariance"]),
        condition=d["condition"],
        findings=tuple(finding_of(each) for each in d["findings"]),
        robot=robot,
        settings=d["settings"],
        seconds=d["seconds"],
        cross_check=_cross_check(d.get("cross_check")),
    )


def _cross_check(d: Mapping[str, Any] | None) -> CrossCheck | None:
    if d is None:
        return None
    return CrossCheck(
        parameters={name: Compared(**each) for name, each in d["parameters"].items()},
        residuals={name: (ours, second) for name, (ours, second) in d["residuals"].items()},
        agrees=d["agrees"],
        reason=d["reason"],
        explained=d["explained"],
    )


_NO_WINDOWS: dict[str, list[float]] = {name: [] for name in WindowTable.__dataclass_fields__}


def _robot(d: Mapping[str, Any], name: str) -> Robot:
    links = d["joints"]
    names = tuple(each["name"] for each in links)

    def of(key: str) -> np.ndarray[Any, np.dtype[np.float64]]:
        return np.array([each[key] for each in links], dtype=np.float64)

    return Robot(
        tree=LinkTree(
            names=names,
            parents=tuple(each["parent"] for each in links),
            rotations=of("rotation"),
            translations=of("translation"),
            axes=of("axis"),
            prismatic=tuple(each["kind"] == "prismatic" for each in links),
            inertias=of("inertial"),
            gravity=np.array(d["gravity"], dtype=np.float64),
        ),
        names=names,
        gear_ratios=None if d["gear_ratios"] is None else tuple(d["gear_ratios"]),
        couplings=np.array(d["couplings"], dtype=np.float64),
        rotor_inertias=tuple(each["rotor_inertia"] for each in links),
        zero_offsets=None if d["zero_offsets"] is None else tuple(d["zero_offsets"]),
        side=d["side"],
        name=name,
        torque_scales=_factors(d, "torque_scales"),
        directions=_factors(d, "directions"),
        drive=_drive(d),
        torque_constants=_factors(d, "torque_constants"),
    )


def _factors(d: Mapping[str, Any], key: str) -> tuple[float, ...] | None:
    return None if d.get(key) is None else tuple(d[key])


def _drive(d: Mapping[str, Any]) -> PositionDrive | None:
    if d.get("drive") is None:
        return None
    try:
        return PositionDrive.of(d["drive"], len(d["joints"]))
    except InputError as error:
        raise error.at("robot") from None


def _contradictions(d: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    """Yield the places of fields that are valid alone but contradict each other."""
    yield from _of_robot(d["robot"])
    names = [each["name"] for each in d["robot"]["joints"]]
    if list(d["joints"]) != names:
        yield "joints", f"the robot has {' '.join(', '.join(names).split())}, in this order"
    for name, each in d["joints"].items():
        yield from _of_joint(name, each, len(d["settings"]["recordings"]))
    if len(d["inertial"]) != len(names):
        yield "inertial", f"{len(names)} lists are expected, one per link"
    if len(d["settings"]["min_speed"]) != len(names):
        yield "settings.min_speed", f"{len(names)} numbers are expected, one per joint"
    every = {f"{name}.{key}" for name, each in d["joints"].items() for key in each["parameters"]}
    base = [each["name"] for each in d["base_parameters"]]
    if len(set(base)) != len(base):
        yield "base_parameters", "a name is there twice"
    every |= set(base)
    free = d["free"]
    if len(set(free)) != len(free):
        yield "free", "a name is there twice"
    for i, name in enumerate(free):
        if name not in every:
            yield f"free[{i}]", "no parameter has this name"
    if any(len(row) != len(free) for row in (d["covariance"], *d["covariance"])):
        count = len(free)
        yield "covariance", f"{count} rows of {count} numbers are expected, one per free parameter"
    yield from empty_calls(d["findings"])


def _of_joint(name: str, d: Mapping[str, Any], recordings: int) -> Iterator[tuple[str, str]]:
    place = f"joints.{name}"
    held = d["parameters"]
    for key, p in held.items():
        if key not in PARAMETERS:
            yield f"{place}.parameters.{key}", f"choose one of {', '.join(PARAMETERS)}"
        if p["name"] != key:
            yield f"{place}.parameters.{key}.name", "the key of this entry is expected"
    terms = terms_of(d["model"])
    offset = () if POSITION_GAIN in held else ("torque_offset",)
    for key in (*(term.name for term in terms if not term.shapes), *offset):
        if key not in held:
            yield f"{place}.parameters.{key}", "this is missing"
    for group in (MOTOR_TERMS, *((term.name, *term.shapes) for term in terms)):
        if 0 < len(held.keys() & set(group)) < len(group):
            yield f"{place}.parameters", f"{' and '.join(group)} go together"
    has = {name for term in terms for name in (term.name, *term.shapes)}
    if is_asymmetric(d["model"]):
        has.add(DIFFERENCE)
    if held.keys() & (FRICTION - MOTOR_TERMS.keys()) != has:
        yield f"{place}.model", "the model does not fit the parameters"
    windows = d["windows"]
    if windows is not None:
        if len({len(column) for column in windows.values()}) > 1:
            yield f"{place}.windows", "lists of the same length are expected"
        if max(windows["recording"]) >= recordings:
            yield (
                f"{place}.windows.recording",
                "an index into settings.recordings is expected",
            )


def _of_robot(d: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    links = d["joints"]
    count = len(links)
    if len({each["name"] for each in links}) != count:
        yield "robot.joints", "a name is there twice"
    for k, each in enumerate(links):
        place = f"robot.joints[{k}]"
        if each["parent"] >= k:
            yield f"{place}.parent", "the index of an earlier link, or -1, is expected"
        rotation = np.array(each["rotation"])
        if np.abs(rotation @ rotation.T - np.eye(3)).max() > _TURNED:
            yield f"{place}.rotation", "a rotation is expected"
        if abs(float(np.linalg.norm(each["axis"])) - 1.0) > _TURNED:
            yield f"{place}.axis", "a vector of length 1 is expected"
    couplings = d["couplings"]
    if any(len(row) != count for row in (couplings, *couplings)):
        yield "robot.couplings", f"{count} rows of {count} numbers are expected"
    elif not np.linalg.cond(np.array(couplings)) <= _SINGULAR:
        yield (
            "robot.couplings",
            "the matrix is singular: motor speeds do not determine joint speeds",
        )
    for key in ("gear_ratios", "zero_offsets", "torque_scales", "directions", "torque_constants"):
        if d.get(key) is not None and len(d[key]) != count:
            yield f"robot.{key}", f"{count} numbers are expected, one per joint"
    if d["gear_ratios"] is not None and 0.0 in d["gear_ratios"]:
        yield "robot.gear_ratios", "a gear ratio is not 0"
