"""A servo's estimate in JSON's types."""

from __future__ import annotations

from typing import Any

from jointid.estimate.json import documents_of, plain
from jointid.joint.joint_file import joint_document
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
