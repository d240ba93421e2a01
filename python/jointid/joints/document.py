"""Several joints' estimates in JSON's types."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

from jointid.base.json_layout import json_types
from jointid.estimate.json import estimate_document
from jointid.joints.record import JointEstimatesRecord, JointResult

SCHEMA = 1
KIND = "jointid joints"


def document_of(result: JointEstimatesRecord) -> dict[str, Any]:
    """Return the result in JSON types; each joint's estimate has the format of its own file."""
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
        "others": [json_types(asdict(share)) for share in result.others],
        "sentences": list(result.sentences()),
        "estimate": None if estimate is None else estimate_document(estimate),
    }
