"""Read a comparison of a servo's models from its JSON."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from jointid.base.errors import InputError
from jointid.base.schema import (
    Flag,
    ListOf,
    Number,
    Plain,
    Record,
    Text,
    Unchecked,
    read_document,
)
from jointid.servo.reading_back import servo_estimate_of
from jointid.servo.record import ServoEstimateRecord

SCHEMA = 1
KIND = "jointid servo comparison"

_MOST = 1_000_000  # runs
_COMPARISON = Record(
    {
        "schema": Number(low=SCHEMA, high=SCHEMA, whole=True),
        "kind": Text(),
        "models": ListOf(Text(), 1, _MOST),
        "runs": ListOf(Text(), 1, _MOST),
        "groups": ListOf(Text(), 1, _MOST),
        "errors": ListOf(ListOf(Number(low=0.0, high=1e100))),
        "bistable": ListOf(ListOf(Flag())),
        "estimate": Unchecked(),  # it has its own reader
    },
    {"best": Plain()},  # it follows from the errors
)


def comparison_fields(text: str, of_estimate: type[ServoEstimateRecord]) -> dict[str, Any]:
    """Return the fields of the comparison that a JSON text holds; see `ServoComparison.from_json`."""
    d = _COMPARISON.read(read_document(text, KIND, SCHEMA, "a comparison of a servo's models"), "")
    for place, reason in _contradictions(d):
        raise InputError(reason, place=place)
    try:
        estimate = servo_estimate_of(d["estimate"], of_estimate)
    except InputError as error:
        raise error.at("estimate") from None
    return {
        **{name: tuple(d[name]) for name in ("models", "runs", "groups")},
        "errors": np.array(d["errors"], dtype=np.float64),
        "bistable": np.array(d["bistable"], dtype=bool),
        "estimate": estimate,
    }


def _contradictions(d: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    """Yield the places of fields that are valid alone but contradict each other."""
    runs = len(d["runs"])
    if len(d["groups"]) != runs:
        yield "groups", "one group for each of the runs is expected"
    for name in ("errors", "bistable"):
        if len(d[name]) != len(d["models"]) or any(len(row) != runs for row in d[name]):
            yield name, f"each model needs a list of {runs} values, one for each run"
