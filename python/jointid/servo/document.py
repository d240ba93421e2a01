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
from jointid.servo.estimate import ServoEstimate
from jointid.servo.reading_back import KIND, SCHEMA, SETTINGS


def document_of(estimate: ServoEstimate) -> dict[str, Any]:
    """Return the estimate in JSON types; an infinite number is the text "inf"."""
    document: dict[str, Any] = {
        "schema": SCHEMA,
        "kind": KIND,
        "joint": joint_document(estimate.joint),
        "parameters": {name: plain(p) for name, p in estimate.parameters.items()},
        "findings": documents_of(estimate.findings),
        "verdict": estimate.verdict.document(),
        "rms": estimate.rms,
        "relative_residual": estimate.relative_residual,
        "settings": {
            name: plain(getattr(estimate, name)) for name in (*SETTINGS.optional, *SETTINGS.fields)
        },
        "seconds": estimate.seconds,
    }
    return document


def json_of(estimate: ServoEstimate) -> str:
    """Return the estimate as JSON text."""
    return json.dumps(document_of(estimate), indent=1, ensure_ascii=False, allow_nan=False)


def save(estimate: ServoEstimate, path: str | Path) -> Path:
    """Write the estimate: see `ServoEstimate.save`."""
    target = require_path("path", path)
    if target.suffix == ".toml":
        estimate.identified.save(target)
    elif target.suffix == ".json":
        write_whole(target, json_of(estimate).encode())
    else:
        raise InputError(
            "a servo's estimate is saved as .json or .toml", argument="path", value=target.name
        )
    return target
