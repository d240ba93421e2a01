"""The exported joint: values, uncertainty and source."""

from __future__ import annotations

import datetime
import math
from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from jointid import _core
from jointid.base.argument_checks import require_kind
from jointid.base.errors import InputError
from jointid.estimate.estimate import Estimate
from jointid.estimate.friction_map import shared_value
from jointid.estimate.statistics import ParameterEstimate
from jointid.exports.law import Law, law_of
from jointid.identification.follow_up import EstimateSource
from jointid.joint.joint import Joint
from jointid.joint.own_terms import POSITION, OwnTerms
from jointid.problem.own_integrals import own_series

_GRAVITY = ("gravity_cos", "gravity_sin")
_SENSOR = ("sensor_gain", "sensor_offset")


@dataclass(frozen=True, slots=True, kw_only=True)
class ExportedValue:
    """One exported parameter."""

    name: str
    meaning: str
    unit: str
    value: float
    stderr: float | None = None  # from random errors only; None: unknown
    interval: tuple[float, float] | None = None  # 95 %; None: unknown
    remark: str = ""  # "fixed", "not well determined by the recording", …
    doubtful: bool = False  # the recording did not determine it, or not well


@dataclass(frozen=True, slots=True, kw_only=True)
class Subject:
    """An exported joint."""

    joint: Joint
    law: Law
    values: tuple[ExportedValue, ...]  # in the order of the torque balance
    model: str
    source: str  # source of the values
    date: str  # date of the export, in UTC
    version: str  # version of the exporting jointid
    findings: tuple[str, ...]  # warnings of the estimate
    speed: float | None  # largest speed of the recordings [rad/s or m/s]; None: unknown
    others: str = ""  # description and size of the torque of other signals, which no file contains

    @property
    def undetermined(self) -> tuple[str, ...]:
        """Names of the parameters that the recording did not determine, or not well."""
        return tuple(each.name for each in self.values if each.doubtful)

    @property
    def unknown(self) -> tuple[str, ...]:
        """Names of the other parameters with unknown uncertainty."""
        return tuple(
            each.name
            for each in self.values
            if each.interval is None and each.remark != "fixed" and not each.doubtful
        )

    @property
    def torque_unit(self) -> str:
        """Unit of the drive's torque or force."""
        return "N" if self.joint.kind == "prismatic" else "N·m"

    @property
    def position_unit(self) -> str:
        """Unit of the position."""
        return "m" if self.joint.kind == "prismatic" else "rad"


def subject_of(value: Estimate | Joint, speed: float | None = None) -> Subject:
    """Return the export of an estimate, or of a joint with values valid up to a speed [rad/s or m/s]."""
    require_kind("source", value, Estimate, Joint)
    subject = _of_estimate(value) if isinstance(value, Estimate) else _of_joint(value)
    for each in subject.values:
        if not math.isfinite(each.value):
            raise InputError(
                "a finite value is expected",
                argument=f"parameters.{each.name}",
                value=each.value,
            )
    return subject if speed is None else _with_speed(subject, speed)


def _with_speed(subject: Subject, speed: float) -> Subject:
    return replace(subject, speed=speed)


def _of_estimate(estimate: Estimate) -> Subject:
    settings = estimate.settings
    terms = tuple(key for key in settings["terms"] if not _core.term(key).own)
    weak = {
        name
        for found in estimate.findings
        if found.code == "undetermined"
        for name in found.parameters
    }
    entries = [_estimated(each, each.name in weak) for each in estimate.parameters.values()]
    runs = [f"{run['name'] or 'unnamed'} ({run['fingerprint']})" for run in settings["recordings"]]
    numbers = {name: parameter.value for name, parameter in estimate.parameters.items()}
    names = dict.fromkeys(name.partition("[")[0] for name in numbers)
    known = {name: shared_value(numbers, name) for name in names}
    speeds = np.abs(estimate.windows.velocity)
    return Subject(
        joint=estimate.joint,
        law=law_of(estimate.joint, terms, known),
        values=tuple(_shared(entries)),
        model=settings["model"],
        source=(
            f"estimate ({estimate.status}) of jointid {settings['version']} from "
            f"{'recording' if len(runs) == 1 else 'recordings'} {', '.join(runs)}"
        ),
        date=_today(),
        version=_core.__version__,
        findings=tuple(
            f"{each.code} ({each.severity}): {each.cause}" for each in estimate.warnings
        ),
        speed=float(speeds.max()) if len(speeds) else None,
        others=_others(estimate.joint, known, estimate),
    )


def _others(joint: Joint, values: Mapping[str, float], estimate: Estimate | None = None) -> str:
    """Return a description of the torque of other signals: coefficients and, if known, size."""
    own = joint.model.resolved.terms
    terms = OwnTerms(tuple(each for each in own.each if each.signal != POSITION))
    if not terms.each:
        return ""
    force, unit = ("force", "N") if joint.kind == "prismatic" else ("torque", "N·m")
    known = [
        f"{key} = {values[key]:.4g}" for each in terms.each for key in each.keys if key in values
    ]
    text = f"the {force} of other signals ({terms}{'; ' * bool(known)}{', '.join(known)})"
    source = None if estimate is None else estimate.follow_up
    if not isinstance(source, EstimateSource):
        return text
    pieces = []
    for run in source.problem.recordings:
        parts = [values[key] * np.diff(each) for key, each in own_series(terms, run)]
        pieces.append(np.sum(parts, axis=0) / np.diff(run.time))
    size = float(np.sqrt(np.mean(np.concatenate(pieces) ** 2)))
    return f"{text}, {size:.4g} {unit} root mean square in the recordings"


def _today() -> str:
    return datetime.datetime.now(datetime.UTC).date().isoformat()


def _estimated(found: ParameterEstimate, weak: bool) -> ExportedValue:
    remark = ""
    interval = found.interval
    if not found.vary:
        remark = "fixed"
    elif found.at_bound is not None:
        remark = f"held at its bound {found.at_bound}: not determined by the recording"
    elif interval is None or not all(map(math.isfinite, interval)):
        remark = "not determined by the recording"
    sound = not remark and found.stderr is not None and math.isfinite(found.stderr)
    if sound and weak:
        remark = "not well determined by the recording"
    return ExportedValue(
        name=found.name,
        meaning=found.meaning,
        unit=found.unit,
        value=found.value,
        stderr=found.stderr if sound else None,
        interval=interval if sound else None,
        remark=remark,
        doubtful=found.vary and bool(remark),
    )


def _shared(entries: list[ExportedValue]) -> list[ExportedValue]:
    """Return one value, the mean, for a parameter that each recording has separately."""
    shared: dict[str, list[ExportedValue]] = {}
    for each in entries:
        shared.setdefault(each.name.partition("[")[0], []).append(each)
    return [
        own[0]
        if len(own) == 1 and own[0].name == name
        else ExportedValue(
            name=name,
            meaning=own[0].meaning,
            unit=own[0].unit,
            value=float(np.mean([each.value for each in own])),
            remark=(
                f"mean of {len(own)} values, one for each recording, from "
                f"{min(each.value for each in own):.6g} to {max(each.value for each in own):.6g}"
            ),
            doubtful=any(each.doubtful for each in own),
        )
        for name, own in shared.items()
    ]


def _of_joint(joint: Joint) -> Subject:
    terms = _terms_of(joint)
    slides = joint.kind == "prismatic"
    values: dict[str, ExportedValue] = {}

    def add(name: str, meaning: str, unit: str, known: float | None = None) -> None:
        parameter = joint.parameters.get(name)
        given = None if parameter is None else parameter.value
        if given is None and known is None:
            if name == "inertia":  # not every target needs it
                return
            raise InputError(
                "an export needs a value of this parameter",
                argument=f"parameters.{name}",
                place=joint.owner,
                remedy="identify the joint, or give the value",
            )
        number = given if given is not None else known
        assert number is not None
        fixed = given is None or (parameter is not None and not parameter.vary)
        remark = "fixed" if fixed else "a joint file does not contain its standard error"
        values[name] = ExportedValue(
            name=name, meaning=meaning, unit=unit, value=number, remark=remark
        )

    shapes = {shape.name: shape for shape in _core.shapes()}
    for key in terms:
        term = _core.term(key)
        unit = term.unit_prismatic if slides else term.unit
        add(term.name, term.meaning, unit, _fact(joint, term.name))
        for name in term.shapes:
            shape = shapes[name]
            add(name, shape.meaning, shape.unit_prismatic if slides else shape.unit)
    for own in joint.model.resolved.terms.each:
        for key in own.keys:
            given = joint.parameters.get(key)
            if own.signal != POSITION and (given is None or given.value is None):
                continue  # depends on signals that no file contains
            term = _core.term(key)
            add(key, term.meaning, term.unit_prismatic if slides else term.unit)
    numbers = {name: each.value for name, each in values.items()}
    return Subject(
        joint=joint,
        law=law_of(joint, terms, numbers),
        values=tuple(values.values()),
        model=str(joint.model.resolved),
        source="stated values of a joint (not an estimate: standard errors are not known)",
        date=_today(),
        version=_core.__version__,
        findings=(),
        speed=joint.limits.velocity,
        others=_others(joint, numbers),
    )


def _fact(joint: Joint, name: str) -> float | None:
    """Return a value that the joint's facts give."""
    if name == "inertia":
        return joint.known_inertia
    if name in _GRAVITY and joint.model.resolved.gravity == "known":
        known = joint.gravity_coefficients
        return known.cos if name == _GRAVITY[0] else known.sin
    return None


def _terms_of(joint: Joint) -> tuple[str, ...]:
    """Return the keys of the terms of a joint's model, in the core's order. The offset needs a value."""
    model = joint.model.resolved
    wanted = {"inertia", *_core.model_terms(model.name, asymmetric=model.asymmetric)}
    wanted |= set(_GRAVITY) if model.gravity != "none" else set()
    wanted |= set(_SENSOR) if joint.sensor else set()
    if model.load_friction:
        behind = model.load_friction == "link"
        wanted |= {t.key for t in _core.terms() if t.needs_load and t.behind_gear == behind}
    offset = joint.parameters.get("torque_offset")
    wanted |= {"torque_offset"} if offset is not None and offset.value is not None else set()
    orders = {"ripple": model.ripple, "harmonics": model.harmonics}
    return tuple(
        key
        for term in _core.terms()
        if not term.own
        for key in (
            [f"{term.key}_{order:g}" for order in orders[term.option]]
            if term.family
            else [term.key] * (term.key in wanted)
        )
    )
