"""A servo's estimate as JSON."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from jointid.base.argument_checks import require_path
from jointid.base.errors import InputError
from jointid.base.files import write_whole
from jointid.estimate.json import documents_of, plain
from jointid.joint.joint_file import joint_document
from jointid.servo.joint_from_estimate import identified_joint
from jointid.servo.reading_back import KIND, SCHEMA, SETTINGS
from jointid.servo.record import ServoEstimateRecord
from jointid.servo.verdict import judged_servo


def document_of(estimate: ServoEstimateRecord) -> dict[str, Any]:
    """Return the estimate in JSON types; an infinite number is the text "inf"."""
    document: dict[str, Any] = {
        "schema": SCHEMA,
        "kind": KIND,
        "joint": joint_document(estimate.joint),
        "parameters": {name: plain(p) for name, p in estimate.parameters.items()},
        "findings": documents_of(estimate.findings),
        "verdict": judged_servo(estimate).document(),
        "rms": estimate.rms,
        "relative_residual": estimate.relative_residual,
        "settings": {
            name: plain(getattr(estimate, name)) for name in (*SETTINGS.optional, *SETTINGS.fields)
        },
        "seconds": estimate.seconds,
    }
    return document


def json_of(estimate: ServoEstimateRecord) -> str:
    """Return the estimate as JSON text."""
    return json.dumps(document_of(estimate), indent=1, ensure_ascii=False, allow_nan=False)


def save(estimate: ServoEstimateRecord, path: str | Path) -> Path:
    """Write the estimate: see `ServoEstimate.save`."""
    target = require_path("path", path)
    if target.suffix == ".toml":
        identified_joint(estimate).save(target)
    elif target.suffix == ".json":
        write_whole(target, json_of(estimate).encode())
    else:
        raise InputError(
            "a servo's estimate is saved as .json or .toml", argument="path", value=target.name
        )
    return target
