"""Read several joints' estimates from their JSON."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, TypeVar

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
    Unchecked,
    read_document,
)
from jointid.estimate.estimate import Estimate
from jointid.estimate.json import estimate_of
from jointid.joints.coupling import Share
from jointid.joints.document import KIND, SCHEMA
from jointid.joints.record import FAILED, IDENTIFIED, JointEstimatesRecord, JointResult
from jointid.joints.signals import MEANING

Saved = TypeVar("Saved", bound=JointEstimatesRecord)

_SHARE = Record(
    {
        "joint": Text(),
        "by": Text(known=tuple(MEANING)),
        "share": Number(low=-1e9, high=1e9),
        "scale": Number(low=0.0, high=1e12),
    },
    {"alike": ListOf(Text()), "own_too": Flag(), "certain": Flag()},
)
_JOINT = Record(
    {
        "status": Text(known=(IDENTIFIED, FAILED)),
        "error": OrNull(Text(longest=1_000_000)),
        "side": Text(known=("joint", "motor")),
        "others": ListOf(_SHARE),
        "estimate": OrNull(Unchecked()),  # it has its own reader
    },
    # These follow from `others`.
    {"explained_by_others": Plain(), "sentences": Plain()},
)
_JOINTS = Record(
    {
        "schema": Number(low=SCHEMA, high=SCHEMA, whole=True),
        "kind": Text(),
        "name": Text(),
        "seconds": Number(low=0.0, high=1e12),
        "joints": TableOf(_JOINT),
    }
)


def read_joints(text: str, cls: type[Saved]) -> Saved:
    """Return the estimates of this class that a JSON text holds; see `JointEstimates.from_json`."""
    d = _JOINTS.read(read_document(text, KIND, SCHEMA, "the estimates of several joints"), "")
    if not d["joints"]:
        raise InputError("at least one joint is expected", place="joints")
    return cls(
        results={name: _result(name, entry) for name, entry in d["joints"].items()},
        name=d["name"],
        seconds=d["seconds"],
    )


def _result(name: str, d: Mapping[str, Any]) -> JointResult:
    place = f"joints.{name}"
    needed = "estimate" if d["status"] == IDENTIFIED else "error"
    for key in ("estimate", "error"):
        if (d[key] is None) is (key == needed):
            reason = "is missing" if key == needed else "does not belong to this status"
            raise InputError(f"this {reason}", place=f"{place}.{key}")
    try:
        estimate = None if d["estimate"] is None else estimate_of(d["estimate"], Estimate)
    except InputError as error:
        raise error.at(f"{place}.estimate") from None
    return JointResult(
        name=name,
        status=d["status"],
        estimate=estimate,
        error=None if d["error"] is None else InputError(d["error"]),
        side=d["side"],
        others=tuple(
            Share(**{**each, "alike": tuple(each.get("alike", ()))}) for each in d["others"]
        ),
    )
