"""Estimates as JSON, complete enough to redraw every picture and to repeat the run."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import fields, is_dataclass
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.base.advice import Action
from jointid.base.errors import InputError
from jointid.base.schema import Number
from jointid.estimate.cross_check import CrossCheck, SecondValue
from jointid.estimate.delays import Delay
from jointid.estimate.derived import derived_values
from jointid.estimate.findings import Finding, Measured
from jointid.estimate.json_schema import ESTIMATE
from jointid.estimate.record import EstimateRecord
from jointid.estimate.selection import Candidate, Selection
from jointid.estimate.settings import model_of
from jointid.estimate.slow_motion import SlowMotion
from jointid.estimate.statistics import Convergence, ParameterEstimate, ResidualStatistics
from jointid.estimate.verdict import judged
from jointid.joint.joint import Joint
from jointid.joint.joint_file import joint_document, joint_from_document
from jointid.problem.window_table import WindowTable

Saved = TypeVar("Saved", bound=EstimateRecord)

SCHEMA = 3
"""Version; increased if a reader of the old form would misread the new one. 2: findings instead of warnings. 3: a
standard error is random only, with systematic parts listed separately."""

_KIND = "jointid estimate"
_OTHERS = {
    "jointid servo": "a servo's estimate",
    "jointid robot": "the estimate of a whole robot",
    "jointid joints": "the estimates of several joints",
    "jointid comparison": "a comparison of models",
    "jointid robot comparison": "a comparison of a robot's models",
    "jointid servo comparison": "a comparison of a servo's models",
}


def estimate_document(estimate: EstimateRecord) -> dict[str, Any]:
    """Return the estimate in JSON's types; an infinite number is the text "inf"."""
    document: dict[str, Any] = {"schema": SCHEMA, "kind": _KIND}
    for item in fields(EstimateRecord):
        if item.name != "follow_up":  # it holds the recordings, which have their own files
            document[item.name] = plain(getattr(estimate, item.name))
    document["derived"] = plain(derived_values(estimate))
    document["verdict"] = judged(estimate).document()
    document["findings"] = documents_of(estimate.findings)
    return document


def estimate_of(document: Any, cls: type[Saved]) -> Saved:
    """Return an estimate of this class from its document.

    Raises
    ------
    InputError
        The document is not an estimate, has a newer schema, or has an invalid field; the place is the JSON path,
        e.g. "parameters.coulomb.value".
    """
    if not isinstance(document, dict) or document.get("kind") != _KIND:
        kind = document.get("kind") if isinstance(document, dict) else None
        if isinstance(kind, str) and kind in _OTHERS:
            raise InputError(f"this is {_OTHERS[kind]}, but the estimate of one joint is expected")
        raise InputError(
            f"this JSON is not a jointid estimate: its field 'kind' is not '{_KIND}'",
            remedy="save one with identify",
        )
    schema = int(Number(low=1, whole=True).read(document.get("schema"), "schema"))
    if schema > SCHEMA:
        reason = f"this version of jointid reads schemas up to {SCHEMA}"
        raise InputError(reason, value=schema, place="schema", remedy="update jointid")
    return _estimate(ESTIMATE[schema].read(document, ""), cls)


def _estimate(d: Mapping[str, Any], cls: type[Saved]) -> Saved:
    for place, reason in _contradictions(d):
        raise InputError(reason, place=place)
    try:
        model_of(d["settings"])
    except InputError as error:
        raise error.at("settings.model") from None
    history = d["convergence"]
    return cls(
        parameters={name: parameter_of(entry) for name, entry in d["parameters"].items()},
        free=tuple(d["free"]),
        status=d["status"],
        message=d["message"],
        penalty=d["penalty"],
        correlation=matrix_of(d["correlation"]),
        condition=d["condition"],
        weakest=tuple(d["weakest"]),
        covariance=matrix_of(d["covariance"]),
        information=None if d.get("information") is None else matrix_of(d["information"]),
        residuals=ResidualStatistics(**d["residuals"]),
        windows=WindowTable(**arrays_of(d["windows"])),
        convergence=None if history is None else Convergence(**arrays_of(history)),
        findings=tuple(finding_of(each) for each in d["findings"])
        if "findings" in d
        else tuple(_old_warning(each) for each in d["warnings"]),
        joint=joint_from_document(d["joint"], "joint", Joint),
        settings=d["settings"],
        seconds=d["seconds"],
        delays={name: Delay(**entry) for name, entry in d.get("delays", {}).items()},
        slow_motion=None if d.get("slow_motion") is None else SlowMotion(**d["slow_motion"]),
        selection=_selection(d.get("selection")),
        cross_check=_cross_check(d.get("cross_check")),
        within=d.get("within", {}),
    )


def _contradictions(d: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    """Yield place and reason of valid fields that contradict each other."""
    names, free = d["parameters"], d["free"]
    for name, entry in names.items():
        if entry["name"] != name:
            yield f"parameters.{name}.name", "this name differs from the key of its entry"
    for name, entry in d.get("delays", {}).items():
        if entry["signal"] != name:
            yield f"delays.{name}.signal", "this name differs from the key of its entry"
    for i, name in enumerate(free):
        if name not in names or name in free[:i]:
            yield f"free[{i}]", "this is not a parameter, or the list has it twice"
    yield from empty_calls(d.get("findings", ()))
    for field in ("correlation", "covariance", "information"):
        matrix = d.get(field)
        if matrix is not None and any(len(row) != len(free) for row in (matrix, *matrix)):
            yield (
                field,
                f"{len(free)} rows of {len(free)} values are expected, one for each free parameter",
            )
    for field in ("windows", "convergence"):
        if d[field] is not None and len({len(column) for column in d[field].values()}) > 1:
            yield field, "lists of the same length are expected"
    if max(d["windows"]["recording"]) >= len(d["settings"]["recordings"]):
        yield "windows.recording", "settings.recordings has no recording with this number"
    if (chosen := d.get("selection")) is not None:
        texts = [each["model"] for each in chosen["candidates"]]
        for field in ("model", "runner_up"):
            if chosen[field] is not None and chosen[field] not in texts:
                yield f"selection.{field}", "this is not one of the candidates"
    values = {name.partition("[")[0] for name in names}  # coulomb[0] is one recording's own
    for i, key in enumerate(d["settings"]["terms"]):
        term = _term(key)
        if term is None or not {term.name, *term.shapes} <= values:
            yield f"settings.terms[{i}]", "this term is unknown, or its parameters are missing"


def empty_calls(findings: Sequence[Mapping[str, Any]]) -> Iterator[tuple[str, str]]:
    """Yield place and reason of findings that advise a call without arguments."""
    for i, found in enumerate(findings):
        for j, action in enumerate(found["advice"]):
            if action["kind"] == "call" and not action["arguments"]:
                yield f"findings[{i}].advice[{j}].arguments", "a call needs arguments"


def _term(key: str) -> _core.Term | None:
    try:
        return _core.term(key)
    except InputError:  # from the core, for an unknown key
        return None


def parameter_of(entry: Mapping[str, Any]) -> ParameterEstimate:
    """Return a parameter from its checked entry."""
    interval = None if entry["interval"] is None else tuple(entry["interval"])
    return ParameterEstimate(**{**entry, "interval": interval})


def _selection(entry: Mapping[str, Any] | None) -> Selection | None:
    if entry is None:
        return None
    return Selection(**{**entry, "candidates": tuple(Candidate(**c) for c in entry["candidates"])})


def _cross_check(entry: Mapping[str, Any] | None) -> CrossCheck | None:
    if entry is None:
        return None
    values = {name: SecondValue(**each) for name, each in entry["values"].items()}
    return CrossCheck(**{**entry, "values": values})


def documents_of(findings: Iterable[Finding]) -> list[dict[str, Any]]:
    """Return findings in JSON's types. Older versions of jointid read the cause, other programs the message."""
    return [{**plain(found), "cause": found.cause, "message": found.message} for found in findings]


def finding_of(entry: Mapping[str, Any]) -> Finding:
    """Return a finding from its checked entry."""
    return Finding(
        code=entry["code"],
        severity=entry["severity"],
        parameters=tuple(entry["parameters"]),
        evidence={name: Measured(**measured) for name, measured in entry["evidence"].items()},
        title=entry.get("title", entry["cause"]),
        details=entry.get("details", ""),
        advice=tuple(_action(each) for each in entry["advice"]),
        recordings=tuple(entry.get("recordings", ())),
    )


def _action(entry: Mapping[str, Any]) -> Action:
    return Action(**{**entry, "arguments": _with_ellipsis(entry["arguments"])})


def _with_ellipsis(value: Any) -> Any:
    """Return an argument of an action; "..." stands for a value that only the user knows."""
    if isinstance(value, Mapping):
        return {name: _with_ellipsis(entry) for name, entry in value.items()}
    if isinstance(value, list):
        return [_with_ellipsis(entry) for entry in value]
    return ... if value == "..." else value


def _old_warning(entry: Mapping[str, Any]) -> Finding:
    """Return a finding from schema 1, which has a complete sentence."""
    return Finding(
        code=entry["code"], parameters=tuple(entry["parameters"]), title=entry["message"]
    )


def matrix_of(rows: Sequence[Sequence[float]]) -> NDArray[np.float64]:
    """Return a square matrix from its rows."""
    return np.array(rows, dtype=np.float64).reshape(len(rows), len(rows))


_INTEGERS = ("recording", "generation", "evaluations")


def arrays_of(columns: Mapping[str, Any]) -> dict[str, Any]:
    """Return arrays from checked lists; some hold integers."""
    return {
        name: np.array(values, dtype=np.int64 if name in _INTEGERS else np.float64)
        for name, values in columns.items()
    }


def plain(value: Any) -> Any:
    """Return any value of an estimate in JSON's types."""
    if isinstance(value, Joint):
        return joint_document(value)
    if isinstance(value, np.ndarray):
        listed = value.tolist()
        if value.dtype.kind in "iu" or (value.dtype.kind == "f" and np.isfinite(value).all()):
            return listed  # a long list of numbers that JSON can hold
        return plain(listed)
    if isinstance(value, bool | int | str) or value is None:
        return value
    if value is ...:
        return "..."
    if isinstance(value, float | np.floating):
        return float(value) if np.isfinite(value) else str(float(value))
    if is_dataclass(value):
        return {item.name: plain(getattr(value, item.name)) for item in fields(value)}
    if isinstance(value, Mapping):
        return {str(key): plain(entry) for key, entry in value.items()}
    if isinstance(value, Sequence):
        return [plain(entry) for entry in value]
    raise TypeError(f"an estimate cannot hold {type(value).__name__}")
