"""A robot's comparison of models from its JSON."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import Any

from jointid.base.errors import InputError
from jointid.base.schema import (
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
from jointid.robot.links.inertia_modes import MODES
from jointid.robot.result.comparison_row import ComparedRobotModel
from jointid.robot.result.reading_back import robot_estimate_of
from jointid.robot.result.record import RobotEstimateRecord

SCHEMA = 1
KIND = "jointid robot comparison"

_SHARE = Number(low=0.0, infinite=True, undefined=True)
_INERTIA = Text(known=MODES)
_ROW = Record(
    {
        "inertia": _INERTIA,
        "model": Text(),
        "parameters": Number(low=0, high=2**53, whole=True),
        "score": _SHARE,
        "stderr": _SHARE,
        "fold_scores": ListOf(_SHARE),
        "joints": TableOf(ListOf(OrNull(_SHARE))),
        "reason": Text(),
    }
)
_COMPARISON = Record(
    {
        "schema": Number(low=SCHEMA, high=SCHEMA, whole=True),
        "kind": Text(),
        "winner": Record({"inertia": _INERTIA, "model": Text()}),
        "models": TableOf(Text()),
        "reason": Text(),
        "rows": ListOf(_ROW, 1),
        "settings": Record(
            {
                "folds": Number(low=1, high=2**53, whole=True),
                "held_out": Text(known=("block", "recording", "recordings")),
                "window_duration": Number(low=1e-9, high=1e9),
                "left_out": TableOf(Text()),
            },
            other=Plain(),
        ),
        "estimate": Unchecked(),  # it has its own reader
    },
    {"bootstrap": Plain()},
)


def comparison_fields(text: str, of_estimate: type[RobotEstimateRecord]) -> dict[str, Any]:
    """Return the fields of the comparison that a JSON text holds; see `RobotComparison.from_json`."""
    d = _COMPARISON.read(read_document(text, KIND, SCHEMA, "a comparison of a robot's models"), "")
    try:
        estimate = robot_estimate_of(d["estimate"], of_estimate)
    except InputError as error:
        raise error.at("estimate") from None
    rows = tuple(_row(each) for each in d["rows"])
    for place, reason in _contradictions(d, list(estimate.joints)):
        raise InputError(reason, place=place)
    return {
        "rows": rows,
        "winner": rows[_winner(d)],
        "models": d["models"],
        "reason": d["reason"],
        "estimate": estimate,
        "settings": d["settings"],
    }


def _row(d: Mapping[str, Any]) -> ComparedRobotModel:
    joints = {
        name: tuple(math.nan if each is None else each for each in scores)
        for name, scores in d["joints"].items()
    }
    return ComparedRobotModel(
        **{**d, "fold_scores": tuple(d["fold_scores"]), "joints": joints},
    )


def _winner(d: Mapping[str, Any]) -> int:
    """Return the index of the chosen row; -1 if it is none of them."""
    wanted = (d["winner"]["inertia"], d["winner"]["model"])
    candidates = [(row["inertia"], row["model"]) for row in d["rows"]]
    return candidates.index(wanted) if wanted in candidates else -1


def _contradictions(d: Mapping[str, Any], joints: list[str]) -> Iterator[tuple[str, str]]:
    """Yield the places of fields that are valid alone but contradict each other."""
    if _winner(d) < 0:
        yield "winner", "no row has this inertia and model"
    named = f"the robot has {', '.join(joints)}, in this order"
    if list(d["models"]) != joints:
        yield "models", named
    for k, row in enumerate(d["rows"]):
        if list(row["joints"]) != joints:
            yield f"rows[{k}].joints", named
