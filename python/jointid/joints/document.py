"""Several joints' estimates as JSON."""

from __future__ import annotations

import json
from dataclasses import asdict
from pathlib import Path
from typing import Any

from jointid.base.argument_checks import require_path
from jointid.base.errors import InputError
from jointid.base.files import write_whole
from jointid.estimate.json import write_estimate
from jointid.joints.record import JointEstimatesRecord, JointResult

SCHEMA = 1
KIND = "jointid joints"


def document_of(result: JointEstimatesRecord) -> dict[str, Any]:
    """Return the result in JSON types; each joint's estimate is the document of its own file."""
    return {
        "schema": SCHEMA,
        "kind": KIND,
        "name": result.name,
        "seconds": result.seconds,
        "joints": {name: _of_joint(each) for name, each in result.results.items()},
    }


def _of_joint(result: JointResult) -> dict[str, Any]:
    estimate = result.estimate
    return {
        "status": result.status,
        "error": None if result.error is None else str(result.error),
        "side": result.side,
        "explained_by_others": result.explained,
        "others": [asdict(share) for share in result.others],
        "sentences": list(result.sentences()),
        "estimate": None if estimate is None else json.loads(write_estimate(estimate)),
    }


def json_of(result: JointEstimatesRecord) -> str:
    """Return the result as JSON text."""
    return json.dumps(document_of(result), indent=1, ensure_ascii=False, allow_nan=False)


def save_json(result: JointEstimatesRecord, path: str | Path) -> Path:
    """Write the result as JSON: see `JointEstimates.save`."""
    target = require_path("path", path)
    if target.suffix != ".json":
        raise InputError(
            "the estimates of several joints are saved as .json", argument="path", value=target.name
        )
    write_whole(target, json_of(result).encode())
    return target
