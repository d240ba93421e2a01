"""Read a servo's estimate from its JSON."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any, TypeVar

import numpy as np

from jointid.base.errors import InputError
from jointid.base.schema import (
    Flag,
    ListOf,
    Number,
    OrNull,
    Plain,
    Record,
    TableOf,
    Text,
)
from jointid.estimate.json import empty_calls, finding_of, parameter_of
from jointid.estimate.json_schema import FINDING, PARAMETER
from jointid.joint.joint import Joint
from jointid.joint.joint_file import joint_from_document
from jointid.servo.layout import DEFAULT_MODEL, LAYOUTS, LOAD_FRICTION, MOTOR
from jointid.servo.record import ServoEstimateRecord

Saved = TypeVar("Saved", bound=ServoEstimateRecord)

SCHEMA = 1
KIND = "jointid servo"

_MOST = 1_000_000  # runs
_ANY = Number(infinite=True, undefined=True)
_TIME = Number(low=-1e9, high=1e9)
_DURATION = Number(low=1e-9, high=1e9)
_SIZE = Number(low=0.0, high=1e100)
_PARTS = ("windows", "lag", "command")
_PARAMETER = Record(
    {
        **PARAMETER.fields,
        "value": Number(low=0.0, infinite=True),
        "systematic": Record({}, optional=dict.fromkeys(_PARTS, _ANY)),
    }
)
SETTINGS = Record(
    {
        "window": _DURATION,
        "slowest": _SIZE,
        "windows": Number(low=0, high=2**53, whole=True),
        "lead": _TIME,
        "lead_found": Flag(),
        "command_lag": OrNull(_TIME),
        LOAD_FRICTION.option: Flag(),
        "separable": Flag(),
        "runs": ListOf(Text(), 1, _MOST),
        "moving": ListOf(Number(low=0.0, high=2.0), 1, _MOST),
    },
    {"model": Text(known=tuple(LAYOUTS))},
)
_ESTIMATE = Record(
    {
        "schema": Number(low=SCHEMA, high=SCHEMA, whole=True),
        "kind": Text(),
        "joint": TableOf(Plain()),  # the joint has its own reader
        "parameters": TableOf(_PARAMETER),
        "findings": ListOf(FINDING),
        "rms": _SIZE,
        "relative_residual": _SIZE,
        "settings": SETTINGS,
        "seconds": _SIZE,
    },
    # A verdict follows from the findings.
    {
        "verdict": Plain(),
        "rollout": Plain(),
    },  # `jointid identify --rollout --json` adds the second one
)


def servo_estimate_of(document: Any, cls: type[Saved]) -> Saved:
    """Return the estimate of this class that a document holds; see `ServoEstimate.from_json`."""
    if not isinstance(document, dict) or document.get("kind") != KIND:
        raise InputError(
            f"this JSON is not a servo's estimate: its field 'kind' is not '{KIND}'",
            remedy="identify a servo and save its estimate",
        )
    d = _ESTIMATE.read(document, "")
    d["settings"].setdefault("model", DEFAULT_MODEL)  # older files do not have it
    for place, reason in _contradictions(d):
        raise InputError(reason, place=place)
    joint = joint_from_document(d["joint"], "joint", Joint)
    if joint.voltage is None:
        raise InputError("a servo's input is a voltage", place="joint.drive.input")
    settings, parameters = d["settings"], d["parameters"]
    names = LAYOUTS[settings["model"]].names
    return cls(
        joint=joint,
        parameters={name: parameter_of(entry) for name, entry in parameters.items()},
        findings=tuple(finding_of(each) for each in d["findings"]),
        values=np.array([parameters[n]["value"] if n in parameters else 0.0 for n in names]),
        draws=np.empty((0, len(names))),
        rms=d["rms"],
        relative_residual=d["relative_residual"],
        seconds=d["seconds"],
        **{**settings, "runs": tuple(settings["runs"]), "moving": tuple(settings["moving"])},
    )


def _contradictions(d: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    """Yield the places of fields that are valid alone but contradict each other."""
    names = d["parameters"]
    needed = {*LAYOUTS[d["settings"]["model"]].names, *MOTOR} - ({LOAD_FRICTION.name} - set(names))
    if set(names) != needed:
        yield "parameters", f"these are expected: {', '.join(sorted(needed))}"
    for name, entry in names.items():
        if entry["name"] != name:
            yield f"parameters.{name}.name", "this name differs from the key of its entry"
    if len(d["settings"]["moving"]) != len(d["settings"]["runs"]):
        yield "settings.moving", "one number for each of the runs is expected"
    yield from empty_calls(d["findings"])
