"""The JSON form of an estimate: complete enough to redraw every picture and to repeat the run."""

import json
from collections.abc import Mapping, Sequence
from dataclasses import fields, is_dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from jointid.base.errors import InputError
from jointid.estimate.estimate import Estimate
from jointid.estimate.statistics import Convergence, ParameterEstimate, ResidualStatistics, Warned
from jointid.joint.joint import Joint
from jointid.joint.joint_file import joint_document, joint_from_document
from jointid.problem.window_table import WindowTable

SCHEMA = 1
"""Raised when a reader of the old form would misread the new one."""

_KIND = "jointid estimate"


def write_estimate(estimate: Estimate) -> str:
    """The estimate as JSON text; an infinite number is the string "inf"."""
    document: dict[str, Any] = {"schema": SCHEMA, "kind": _KIND}
    for item in fields(Estimate):
        document[item.name] = _plain(getattr(estimate, item.name))
    return json.dumps(document, indent=1, ensure_ascii=False, allow_nan=False)


def read_estimate(text: str) -> Estimate:
    """An estimate from its JSON text.

    Raises
    ------
    InputError
        Not JSON, not an estimate, a newer schema, or a missing field.
    """
    try:
        document = json.loads(text)
    except json.JSONDecodeError as error:
        raise InputError(
            f"not JSON: {error}; an estimate is saved with estimate.save('name.json')"
        ) from error
    if not isinstance(document, dict) or document.get("kind") != _KIND:
        raise InputError(f"this JSON is not a jointid estimate: its field 'kind' is not '{_KIND}'")
    if document.get("schema") != SCHEMA:
        raise InputError(
            f"the estimate has schema {document.get('schema')!r}, this jointid reads {SCHEMA}; update jointid"
        )
    try:
        return _estimate(document)
    except (ArithmeticError, AttributeError, LookupError, TypeError, ValueError) as error:
        raise InputError(
            f"the estimate's JSON is damaged: {type(error).__name__} {error}"
        ) from error


def _estimate(d: Mapping[str, Any]) -> Estimate:
    history = d["convergence"]
    return Estimate(
        parameters={name: _parameter(entry) for name, entry in d["parameters"].items()},
        free=tuple(d["free"]),
        status=d["status"],
        message=d["message"],
        penalty=float(d["penalty"]),
        correlation=_matrix(d["correlation"]),
        condition=float(d["condition"]),
        weakest=tuple(d["weakest"]),
        covariance=_matrix(d["covariance"]),
        residuals=ResidualStatistics(**d["residuals"]),
        windows=WindowTable(**_arrays(d["windows"], integers=("recording",))),
        convergence=None
        if history is None
        else Convergence(**_arrays(history, integers=("generation", "evaluations"))),
        warnings=tuple(
            Warned(code=w["code"], parameters=tuple(w["parameters"]), message=w["message"])
            for w in d["warnings"]
        ),
        joint=joint_from_document(d["joint"], "estimate"),
        settings=d["settings"],
        seconds=float(d["seconds"]),
    )


def _parameter(entry: Mapping[str, Any]) -> ParameterEstimate:
    values = dict(entry)
    for name in ("stderr", "shift_halved", "shift_doubled"):
        values[name] = None if values[name] is None else float(values[name])
    if values["interval"] is not None:
        values["interval"] = (float(values["interval"][0]), float(values["interval"][1]))
    return ParameterEstimate(**values)


def _matrix(rows: Sequence[Sequence[Any]]) -> NDArray[np.float64]:
    matrix = np.array([[float(x) for x in row] for row in rows], dtype=np.float64)
    return matrix.reshape(len(rows), len(rows))


def _arrays(columns: Mapping[str, Any], *, integers: Sequence[str]) -> dict[str, Any]:
    return {
        name: np.array(values, dtype=np.int64 if name in integers else np.float64)
        for name, values in columns.items()
    }


def _plain(value: Any) -> Any:
    """JSON's own types for everything an estimate holds."""
    if isinstance(value, Joint):
        return joint_document(value)
    if isinstance(value, np.ndarray):
        return _plain(value.tolist())
    if isinstance(value, bool | int | str) or value is None:
        return value
    if isinstance(value, float | np.floating):
        return float(value) if np.isfinite(value) else str(float(value))
    if is_dataclass(value):
        return {item.name: _plain(getattr(value, item.name)) for item in fields(value)}
    if isinstance(value, Mapping):
        return {str(key): _plain(entry) for key, entry in value.items()}
    if isinstance(value, Sequence):
        return [_plain(entry) for entry in value]
    raise TypeError(f"an estimate cannot hold {type(value).__name__}")
