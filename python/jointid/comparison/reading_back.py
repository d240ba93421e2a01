"""Read a comparison of models from its JSON."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from jointid.base.errors import InputError
from jointid.base.schema import (
    Flag,
    ListOf,
    Number,
    Plain,
    Record,
    TableOf,
    Text,
    Unchecked,
    read_document,
)
from jointid.comparison.row import ComparedModel
from jointid.estimate.json import estimate_of
from jointid.estimate.record import EstimateRecord
from jointid.joint.model import Model
from jointid.problem.terms import RESIDUALS

SCHEMA = 1
"""Version of the format. It increases if a reader of the earlier format would misread the new one."""
KIND = "jointid comparison"

_SHARE = Number(low=0.0, infinite=True, undefined=True)
_ROW = Record(
    {
        "model": Text(),
        "spec": TableOf(Plain()),  # the model has its own reader
        "parameters": Number(low=0, high=2**53, whole=True),
        **dict.fromkeys(("score", "stderr", "penalty"), _SHARE),
        "fold_scores": ListOf(_SHARE),
        "eligible": Flag(),
        "reason": Text(),
    }
)
_COMPARISON = Record(
    {
        "schema": Number(low=SCHEMA, high=SCHEMA, whole=True),
        "kind": Text(),
        "winner": Text(),
        "reason": Text(),
        "rows": ListOf(_ROW, 1),
        "settings": Record(
            {
                "folds": Number(low=1, high=2**53, whole=True),
                "held_out": Text(known=("block", "recording", "recordings")),
                "residual": Text(known=RESIDUALS),
                "left_out": TableOf(Text()),
            },
            other=Plain(),
        ),
        "estimate": Unchecked(),  # it has its own reader
    }
)


def comparison_fields(text: str, of_estimate: type[EstimateRecord]) -> dict[str, Any]:
    """Return the fields of the comparison that a JSON text holds; see `Comparison.from_json`."""
    d = _COMPARISON.read(read_document(text, KIND, SCHEMA, "a comparison of models"), "")
    if d["winner"] not in [row["model"] for row in d["rows"]]:
        raise InputError("no row has this model", value=d["winner"], place="winner")
    try:
        estimate = estimate_of(d["estimate"], of_estimate)
    except InputError as error:
        raise error.at("estimate") from None
    return {
        "rows": tuple(_row(each, f"rows[{k}].spec") for k, each in enumerate(d["rows"])),
        "winner": d["winner"],
        "reason": d["reason"],
        "estimate": estimate,
        "settings": d["settings"],
    }


def _row(d: Mapping[str, Any], place: str) -> ComparedModel:
    try:
        spec = Model.of(d["spec"])
    except InputError as error:
        raise error.at(place) from None
    return ComparedModel(**{**d, "spec": spec, "fold_scores": tuple(d["fold_scores"])})
