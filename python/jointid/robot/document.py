"""A robot's estimate as JSON."""

from __future__ import annotations

import json
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np

from jointid.base.argument_checks import require_path
from jointid.base.errors import InputError
from jointid.base.files import write_whole
from jointid.estimate.findings import Finding
from jointid.estimate.statistics import ParameterEstimate
from jointid.robot.result import RobotEstimate

SCHEMA = 1
KIND = "jointid robot"


def document_of(estimate: RobotEstimate) -> dict[str, Any]:
    """Return the estimate in JSON types; what is infinite is null."""
    robot = estimate.robot
    return {
        "schema": SCHEMA,
        "kind": KIND,
        "name": robot.name,
        "seconds": estimate.seconds,
        "inertia": estimate.inertia,
        "consistent": estimate.consistent,
        "relative_residual": estimate.relative_residual,
        "condition": _finite(estimate.condition),
        "joints": {
            name: {
                "model": joint.model,
                "parameters": {key: _parameter(p) for key, p in joint.parameters.items()},
                "residuals": _finite(asdict(joint.residuals)),
            }
            for name, joint in estimate.joints.items()
        },
        "base_parameters": [_parameter(p) for p in estimate.base_parameters.values()],
        "inertial": estimate.inertial.tolist(),
        "free": list(estimate.free),
        "covariance": _finite(estimate.covariance.tolist()),
        "couplings": robot.couplings.tolist(),
        "gear_ratios": None if robot.gear_ratios is None else list(robot.gear_ratios),
        "rotor_inertias": list(robot.rotor_inertias),
        "findings": [_finding(each) for each in estimate.findings],
        "settings": dict(estimate.settings),
    }


def json_of(estimate: RobotEstimate) -> str:
    """Return the estimate as JSON text."""
    return json.dumps(document_of(estimate), indent=1, ensure_ascii=False, allow_nan=False)


def save_json(estimate: RobotEstimate, path: str | Path) -> Path:
    """Write the estimate as JSON: see `RobotEstimate.save`."""
    target = require_path("path", path)
    if target.suffix != ".json":
        raise InputError("a robot's estimate is saved as .json", argument="path", value=target.name)
    write_whole(target, json_of(estimate).encode())
    return target


def _parameter(p: ParameterEstimate) -> Any:
    return _finite(asdict(p))


def _finding(found: Finding) -> dict[str, Any]:
    return {
        "code": found.code,
        "severity": found.severity,
        "parameters": list(found.parameters),
        "evidence": {name: asdict(each) for name, each in found.evidence.items()},
        "cause": found.cause,
        "advice": [str(each) for each in found.advice],
        "message": found.message,
    }


def _finite(value: Any) -> Any:
    """Return a value with None for what no JSON number can be."""
    if isinstance(value, dict):
        return {key: _finite(each) for key, each in value.items()}
    if isinstance(value, list | tuple):
        return [_finite(each) for each in value]
    if isinstance(value, float | np.floating):
        return float(value) if np.isfinite(value) else None
    return value
