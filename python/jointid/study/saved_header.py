"""Read and check the first line of a study's file."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from jointid.base.errors import InputError
from jointid.base.schema import Json, ListOf, Number, Plain, Record, TableOf, Text

FORMAT = "jointid-study"
KIND = "jointid study"  # format name in its JSON
SCHEMA = 1
EXPECTED = "a file that a sweep wrote is expected"


# A label or a setting is only shown and compared. It may have any length and be not finite.
_VALUE = Json(finite=False)


@dataclass(frozen=True, slots=True)
class _Label:
    """A label of a swept value."""

    def read(self, value: Any, place: str) -> Any:
        """Return the value."""
        if isinstance(value, list | dict):
            raise InputError("a text or a number is expected", value=value, place=place)
        return _VALUE.read(value, place)


_HEADER = Record(
    fields={
        "format": Text(),
        "schema": Number(low=SCHEMA, high=SCHEMA, whole=True),
        "fingerprint": Text(),
        "trials": Number(low=1, high=1e9, whole=True),
        "seed": Number(low=0, high=2**64 - 1, whole=True),
        "swept": ListOf(Text()),
        "cells": ListOf(TableOf(_Label()), shortest=1),
        "truth": TableOf(Number()),
        "truths": ListOf(TableOf(Number())),
        "settings": TableOf(_VALUE),
    },
    optional={"version": Text()},
    other=Plain(),
)


def read_header(record: object, before: dict[str, Any] | None) -> dict[str, Any]:
    """Return the checked header.

    Parameters
    ----------
    record : object
        Record of JSON types.
    before : dict or None
        An earlier header of the same file, after which the number of trials changed.

    Raises
    ------
    InputError
        The record is not the header of a study, of this schema, or of the same study as before.
    """
    if not isinstance(record, dict) or record.get("format") != FORMAT:
        raise InputError(f"this is not the first line of a study; {EXPECTED}")
    if record.get("schema") != SCHEMA:
        raise InputError(
            f"this version of jointid reads schema {SCHEMA}",
            argument="schema",
            value=record.get("schema"),
        )
    header = _HEADER.read(record, "")
    if any(cell.keys() != set(header["swept"]) for cell in header["cells"]):
        raise InputError("each cell needs a value of each swept setting", argument="cells")
    if len(header["truths"]) not in (0, len(header["cells"])):
        raise InputError("one truth for each cell is expected", argument="truths")
    for name in ("fingerprint", "swept", "cells"):
        if before is not None and header[name] != before[name]:
            raise InputError("this field differs from the first line of the file", argument=name)
    return header
