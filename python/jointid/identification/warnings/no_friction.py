"""A torque without friction although the joint moves: measured at the link, or of a joint without friction."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from jointid.base.advice import Action
from jointid.estimate.findings import Finding, Measured, Severity
from jointid.estimate.statistics import ParameterEstimate
from jointid.estimate.wording import percent
from jointid.identification.warnings.check import Check, FindingType
from jointid.identification.warnings.evidence import Evidence
from jointid.recording.header_words import AT_THE_LINK

NO_FRICTION = FindingType(
    code="no_friction",
    meaning="friction is less than 2 % of the torque. The torque was measured at the link, or the joint has no "
    "friction, as in a simulation. Blocking: friction is less than 5 % of the torque, and the header of the torque "
    "column names the joint or a sensor",
    advice="load the motor's torque or current as torque, and the torque at the link as sensor. Do nothing if the "
    "joint has no friction",
)
_EXPLAINED = 0.95  # of the variance: friction is absent, not hidden in a residual
_SMALL = 0.02  # of the torque's root mean square
_SMALL_AT_THE_LINK = 0.05  # higher, because the link's bearings have friction
# no drive has viscous friction alone: it is noise, or a damper of a simulation
_SMALL_WITHOUT_DRY = 0.1
_SURE = 3.0  # standard errors
_BOUND = 2.0  # standard errors
_LEVELS = ("coulomb", "static")
_CAUSE = "a torque measured at the link contains no friction of the drive"
_REMEDY = "where the torque is measured, and load the motor's torque or current"


def without_friction(evidence: Evidence) -> tuple[str, ...]:
    """Return the friction parameters of an estimate with negligible friction; empty if there is friction."""
    friction = [p for p in evidence.parameters.values() if _is_friction(p)]
    if not any(p.vary for p in friction) or evidence.residuals.r_squared < _EXPLAINED:
        return ()
    header = bool(_header(evidence))
    shown = any(p.stderr is not None and p.value > _SURE * p.stderr for p in friction)
    beyond = any((p.value if not p.vary else p.at_bound == "max") for p in friction)
    if (shown and not header) or beyond:
        return ()
    share = _SMALL_AT_THE_LINK if header else _SMALL
    dry = [p for p in friction if _kind(p) in _LEVELS]
    if dry and _most(evidence, dry) < _SMALL * evidence.torque_level:
        share = _SMALL_WITHOUT_DRY
    return (
        tuple(p.name for p in friction)
        if _most(evidence, friction) < share * evidence.torque_level
        else ()
    )


def _most(evidence: Evidence, friction: list[ParameterEstimate]) -> float:
    """Return an upper bound of the friction in the recorded motion [N·m or N]."""
    speed = 0.0
    if any(_kind(p) == "viscous" for p in friction):
        speed = float(np.sqrt(np.mean(np.square(evidence.table.velocity))))
    sizes = [p.value + _BOUND * (p.stderr or 0.0) for p in friction]
    return sum(
        size * (1.0 if _kind(p) in _LEVELS else speed)
        for p, size in zip(friction, sizes, strict=True)
    )


def _kind(p: ParameterEstimate) -> str:
    return p.name.partition("[")[0].partition("_")[0]


def _is_friction(p: ParameterEstimate) -> bool:
    return _kind(p) in (*_LEVELS, "viscous")


def _header(evidence: Evidence) -> str:
    """Return the torque's header if it names the joint's side of the drive; empty if it does not."""
    headers = (str(run.metadata.get(AT_THE_LINK, "")) for run in evidence.recordings)
    return next(filter(None, headers), "")


def _find(evidence: Evidence) -> Iterator[Finding]:
    names = without_friction(evidence)
    if not names:
        return
    header = _header(evidence)
    share = _most(evidence, [evidence.parameters[name] for name in names]) / evidence.torque_level
    severity: Severity = "warning"
    details = f"{_CAUSE}; this finding is normal for a joint that was simulated without friction"
    if header:
        severity, details = "blocking", f"{_CAUSE}; the torque's header is {header!r}"
    yield NO_FRICTION.finding(
        f"the torque contains no friction: friction is at most {percent(share)} of the torque in motion",
        Action("inspect", text=_REMEDY),
        *((_as_sensor(header),) if header else ()),
        details=details,
        evidence={"friction": Measured(share), "torque": _level(evidence)},
        parameters=names,
        severity=severity,
    )


def _as_sensor(header: str) -> Action:
    columns = {"torque": ..., "sensor": header}
    return Action("call", {"columns": columns}, "with the motor's column", "load")


def _level(evidence: Evidence) -> Measured:
    return Measured(evidence.torque_level, evidence.recordings[0].unit("torque"))


CHECK = Check(_find, (NO_FRICTION,))
