"""Kind of result in a file or a JSON text."""

from __future__ import annotations

from collections.abc import Mapping
from importlib import import_module
from pathlib import Path
from typing import Any

from jointid.base.errors import InputError
from jointid.base.result import KINDS, KeptResult
from jointid.base.schema import read_json, read_text
from jointid.base.toml_file import read_toml

# Module and class of each kind; the module is imported when a file holds this kind.
_HOMES = {
    "estimate": "jointid.estimate.estimate:Estimate",
    "joints": "jointid.joints.result:JointEstimates",
    "robot": "jointid.robot.result.result:RobotEstimate",
    "servo": "jointid.servo.estimate:ServoEstimate",
    "comparison": "jointid.comparison.result:Comparison",
    "robot comparison": "jointid.robot.result.comparison_result:RobotComparison",
    "servo comparison": "jointid.servo.comparison_result:ServoComparison",
    "design": "jointid.excitation.design:Design",
    "study": "jointid.study.study_result:Study",
}
_MARK = "jointid "  # before a kind in a document
_STUDY = "jointid-study"
_REMEDY = "save a result with its method save"


def class_of_kind(source: Path | str) -> type[KeptResult]:
    """Return the class of the result in a file (a Path) or a JSON text (a str).

    Raises
    ------
    InputError
        There is no such file, it is not JSON, or it holds no result of a known kind. The error names the file.
    """
    if isinstance(source, str):
        return _class_of(_kind_of(read_json(source)))
    try:
        return _class_of(_kind_of_file(source))
    except InputError as error:
        raise (error if error.place.startswith(str(source)) else error.at(str(source))) from None


def _kind_of_file(path: Path) -> str:
    ending = path.suffix.lower()
    if ending == ".jsonl":
        return "study"
    if ending == ".toml":
        return _kind_of(read_toml(path))
    if ending != ".json":
        raise InputError(
            "a result is read from .json, .toml or .jsonl", argument="path", value=path.name
        )
    return _kind_of(read_json(read_text(path)))


def _kind_of(document: Any) -> str:
    """Return the kind that a document names; designs and studies name none, and are recognized by their keys."""
    if not isinstance(document, Mapping):
        raise InputError("this is not a result of jointid", remedy=_REMEDY)
    kind = document.get("kind")
    if isinstance(kind, str) and kind.startswith(_MARK):
        return kind.removeprefix(_MARK)
    if document.get("format") == _STUDY:
        return "study"
    if {"trajectory", "design"} <= document.keys():
        return "design"
    raise InputError("this is not a result of jointid", remedy=_REMEDY)


def _class_of(kind: str) -> type[KeptResult]:
    if kind not in _HOMES:
        known = kind in KINDS
        reason = f"a result of the kind '{kind}' cannot be read from a file"
        raise InputError(
            reason if known else f"this version of jointid does not know the kind '{kind}'"
        )
    module, _, name = _HOMES[kind].partition(":")
    found: type[KeptResult] = getattr(import_module(module), name)
    return found
