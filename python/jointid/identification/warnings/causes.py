"""Named causes of a residual: the missing effect, its share of the residual, and the values that it changes."""

from __future__ import annotations

from collections.abc import Iterator

from jointid.estimate.causes import Cause
from jointid.estimate.findings import Finding, Severity
from jointid.identification.causes.families import FAMILIES
from jointid.identification.warnings.check import Check
from jointid.identification.warnings.evidence import Evidence
from jointid.identification.warnings.ripple import RIPPLE
from jointid.identification.warnings.torque_balance import GROSS, WRONG_SCALE, scaled_with_torque
from jointid.identification.warnings.undetermined import listed, wide, with_partners

_LITTLE = 0.1  # of the sum of squares
# relative change of a value by a single recording: the value then applies to no recording
_APART = 0.1
_NOTED = 0.3  # share of the residual that a harmless cause explains; causes with less are only in `estimate.causes()`

_OWN = {each.code: each for each in (RIPPLE, WRONG_SCALE)}
TYPES = {family.name: family.finding_type for family in FAMILIES} | _OWN


def _find(evidence: Evidence) -> Iterator[Finding]:
    if evidence.causes is None:
        return
    # This cause has its own check with more detail.
    causes = [each for each in evidence.causes.found if not _is_known_delay(each, evidence)]
    uncertain = wide(evidence)
    for number, cause in enumerate(causes):
        # The residual also makes values uncertain that the first-order shift does not show.
        names = (*cause.relative, *(uncertain if number == 0 else ()))
        if cause.name == "wrong_scale":
            names = (*names, *scaled_with_torque(evidence))
        yield _finding(cause, with_partners(evidence, names), missed=_missed(evidence))
    for cause in evidence.causes.harmless:
        if cause.share > _NOTED and not _is_known_delay(cause, evidence):
            yield _note(cause)


def _is_known_delay(cause: Cause, evidence: Evidence) -> bool:
    delay = evidence.delays.get(cause.detail) if cause.name == "delay" else None
    return delay is not None and delay.certain


def _missed(evidence: Evidence) -> bool:
    """Return whether the model explains far less than the mean of the measurement."""
    left = evidence.residuals
    return left.r_squared < 0.0 and left.relative**2 > _LITTLE


def _finding(cause: Cause, concerned: tuple[str, ...], *, missed: bool) -> Finding:
    measured = cause.evidence(cause.relative)
    beside = [name for name in concerned if name not in cause.relative]
    also = "it also makes {} uncertain"
    if cause.name == "wrong_scale":
        also = "if the torque is wrong, this error also scales {}"
    does = f"; {also.format(listed(beside))}" if beside else ""
    severity: Severity = "blocking" if _is_gross(cause, missed) else "warning"
    return TYPES[cause.name].finding(
        cause.title,
        *cause.advice,
        details=cause.details + does,
        evidence=measured,
        parameters=tuple(concerned),
        severity=severity,
    )


def _is_gross(cause: Cause, missed: bool) -> bool:
    """Return whether a scale is so wrong that every value is wrong, or the values apply to no recording."""
    if cause.name == "other_run":
        return max(map(abs, cause.relative.values()), default=0.0) > _APART
    if cause.name != "wrong_scale":
        return False
    ratio = cause.numbers["ratio"].value
    return missed or not 1.0 / GROSS < ratio < GROSS


def _note(cause: Cause) -> Finding:
    """Return the finding of a cause that is harmless."""
    return TYPES[cause.name].finding(
        cause.title,
        details=cause.details,
        evidence=cause.evidence(cause.shares),
        parameters=tuple(cause.relative),
        severity="info",
    )


CHECK = Check(_find, tuple(each for code, each in TYPES.items() if code not in _OWN))
