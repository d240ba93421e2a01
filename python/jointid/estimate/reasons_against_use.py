"""Reasons against the use of an estimate, from its findings."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable
from typing import TYPE_CHECKING

from jointid import _core
from jointid.base.values import dataclass
from jointid.estimate.derived import sums_of_splits
from jointid.estimate.wording import two_digits

if TYPE_CHECKING:
    from jointid.estimate.findings import Finding
    from jointid.estimate.record import EstimateRecord
    from jointid.estimate.self_test import SelfTest
    from jointid.estimate.statistics import ParameterEstimate

EXPLAINED = 0.9  # least explained share of the windows' variance
_MATTERS = 0.05  # of a value: a smaller tolerance has little effect
LARGE = 0.1
"""Share of all friction: a part of it with a larger error is unknown."""
_HALF = 0.5  # of a value: with a larger error it is unknown
# Findings that are effects and name no cause.
_SYMPTOMS = frozenset(
    (
        *("explained", "self_test", "at_bound", "model_too_rich", "few_windows", "poor_fit"),
        *("structured_residual", "given", "errors"),
    )
)
_MOST = 0.5  # share of the residual: its cause is listed before its effects


@dataclass(frozen=True, slots=True, kw_only=True)
class Objection:
    """One reason against the use of an estimate.

    Attributes
    ----------
    code : str
        Code of the finding.
    reason : str
        The reason as a sentence.
    blocking : bool
        Whether the values must not be used.
    parameters : tuple of str
        Affected parameters; empty for all.
    share : float
        Share of the residual that it causes. Default 0.
    """

    code: str
    reason: str
    blocking: bool
    parameters: tuple[str, ...]
    share: float = 0.0

    @property
    def rank(self) -> int:
        """Rank among the reasons: causes before effects, blocking before others."""
        cause = self.code not in _SYMPTOMS
        if self.blocking and cause:
            return 0
        if cause and self.share > _MOST:
            return 1
        return 2 if self.blocking else 3


def objections_of(estimate: EstimateRecord, self_test: SelfTest | None) -> Iterable[Objection]:
    """Yield the reasons from findings, the residual, a self-test, and the tolerances of stated facts."""
    for found in estimate.findings:
        if found.severity != "info" and not _is_of_compensation(found):
            yield Objection(
                code=found.code,
                reason=found.title,
                blocking=found.severity == "blocking",
                parameters=_free(estimate, found),
                share=found.evidence["share"].value if "share" in found.evidence else 0.0,
            )
    explained, of_what = _explained(estimate)
    if not _missed(estimate):
        explained = 1.0 - (1.0 - explained) * (1.0 - _named_share(estimate))
    if not explained >= EXPLAINED:
        yield Objection(
            code="explained",
            reason=explained_text(explained, of_what),
            blocking=True,
            parameters=(),
        )
    if self_test is not None and self_test.lost:
        yield Objection(
            code="self_test",
            reason=f"the self-test does not recover the known values of {', '.join(self_test.lost)}",
            blocking=True,
            parameters=self_test.lost,
        )
    given = tuple(p.name for p in estimate.parameters.values() if _rests_on_given(p))
    if given:
        names = ", ".join(given)
        reason = f"the stated facts of the joint cause most of the uncertainty of {names}"
        yield Objection(code="given", reason=reason, blocking=False, parameters=given)


def explained_text(explained: float, of_what: str) -> str:
    """Return a sentence with the share of a variance that the model explains."""
    share = f"{100.0 * explained:.0f} %" if explained > 0.005 else "nothing"
    return f"the model explains {share} of the variance of {of_what}"


def no_values(estimate: EstimateRecord, asked: tuple[str, ...]) -> Iterable[Objection]:
    """Yield friction and sensor parameters without a value: on a bound, or part of a sum that cannot be separated.

    If friction differs by direction, no motion can separate an offset from it, and no purpose needs this separation.
    """
    yield from held_on_bounds(estimate.findings, asked)
    doubted = _named(estimate.findings, "undetermined")
    merged = tuple(
        name
        for name, share in doubted.items()
        if name in asked
        and acts_against_motion(name)
        and _is_split(estimate.parameters[name], share)
    )
    if merged:
        sums = "".join(
            f"; {each.formula} is {each.value:.4g} ± {two_digits(each.interval[1] - each.value)} {each.unit}"
            for each in sums_of_splits(estimate)
            if each.interval is not None and set(each.name.split("_and_")) & set(merged)
        )
        yield Objection(
            code="undetermined",
            reason=f"compensation and simulation need {' and '.join(merged)}, but this recording does not "
            f"separate their values{sums}",
            blocking=True,
            parameters=merged,
        )


def held_on_bounds(findings: Iterable[Finding], asked: Collection[str]) -> Iterable[Objection]:
    """Yield friction on its bound that may be more than a tenth of all friction."""
    bounded = _named(findings, "at_bound")
    needed = tuple(name for name, share in bounded.items() if name in asked and share > LARGE)
    if needed:
        yield Objection(
            code="at_bound",
            reason=f"compensation and simulation need {' and '.join(needed)}, which ended on a bound and have no value",
            blocking=True,
            parameters=needed,
        )


def without_friction(estimate: EstimateRecord) -> Iterable[Objection]:
    """Yield the reason that the torque contains no friction; it affects only compensation."""
    for found in estimate.findings:
        if _is_of_compensation(found):
            yield Objection(
                code=found.code,
                reason=found.title,
                blocking=True,
                parameters=_free(estimate, found),
            )


def _is_of_compensation(found: Finding) -> bool:
    """Whether a finding affects only compensation: a friction of 0 is a valid value for a frictionless joint."""
    return found.code == "no_friction" and found.severity == "warning"


def _is_split(p: ParameterEstimate, share: float) -> bool:
    """Whether only a sum is known: the error is infinite, or half of the value and much of all friction.

    `share` is half of the parameter's interval over all friction.
    """
    if p.stderr is not None and math.isinf(p.stderr):
        return True
    half = 0.0 if p.interval is None else 0.5 * (p.interval[1] - p.interval[0])
    return share > LARGE and half > _HALF * abs(p.value)


def hidden_inertia(estimate: EstimateRecord, asked: tuple[str, ...]) -> Iterable[Objection]:
    """Yield an inertia that the recording does not determine: unlike friction, an inertia cannot be zero."""
    doubted = _named(estimate.findings, "undetermined")
    for name, p in estimate.parameters.items():
        if name.partition("[")[0] != "inertia":
            continue
        if p.at_bound is not None:  # not among the free parameters
            yield Objection(
                code="at_bound",
                reason=f"a simulation needs {name}, but this parameter ended on its bound",
                blocking=True,
                parameters=(name,),
            )
        elif name in asked and name in doubted and p.interval is not None and p.interval[0] <= 0.0:
            yield Objection(
                code="undetermined",
                reason=f"a simulation needs {name}, but its 95 % interval reaches zero",
                blocking=True,
                parameters=(name,),
            )


def _named(findings: Iterable[Finding], code: str) -> dict[str, float]:
    """Return parameter → share of all friction (0 if not stated), from warnings with this code."""
    return {
        name: found.evidence[key].value if (key := f"{name}.share") in found.evidence else 0.0
        for found in findings
        if found.code == code and found.severity != "info"
        for name in found.parameters
    }


def _free(estimate: EstimateRecord, found: Finding) -> tuple[str, ...]:
    return tuple(name for name in found.parameters if name in estimate.parameters)


def _named_share(estimate: EstimateRecord) -> float:
    """Return the share of the residual with a named cause; its finding states the effect, so that care is enough."""
    shares = [
        found.evidence["share"].value
        for found in estimate.findings
        if found.severity == "warning" and found.parameters and "share" in found.evidence
    ]
    return min(1.0, max(0.0, *shares)) if shares else 0.0


def _explained(estimate: EstimateRecord) -> tuple[float, str]:
    """Return the explained share of the variance, of the held-out torque if there is any, and the name of this torque.

    A well explained torque does not excuse a poorly explained reading: they do not belong together, e.g. because one is
    late. A nearly constant reading may be explained worse than by its mean, if the residual is small.
    """
    left = estimate.residuals
    if estimate.selection is not None and not _missed(estimate):
        chosen = estimate.selection[estimate.selection.model]
        if math.isfinite(chosen.score):
            return 1.0 - chosen.score * chosen.score, "the held-out torque"
    return left.r_squared, "the windows"


def _missed(estimate: EstimateRecord) -> bool:
    """Whether the model explains nothing of the measured signal; then even a named cause is no excuse."""
    left = estimate.residuals
    return left.r_squared < 0.0 and left.relative**2 > 1.0 - EXPLAINED


def _rests_on_given(p: ParameterEstimate) -> bool:
    given = p.systematic.get("given", 0.0)
    others = [size for name, size in p.systematic.items() if name != "given"]
    return given > max(math.hypot(p.stderr or 0.0, *others), _MATTERS * abs(p.value))


def acts_against_motion(name: str) -> bool:
    """Whether friction compensation needs a parameter; it needs no inertia and no gravity."""
    base = name.partition("[")[0]
    rows = {row.name: row for row in _core.terms()}
    row = rows.get(base)
    if row is not None and not row.family:
        return bool(row.friction) or base.startswith("sensor_")
    shapes = {shape for each in rows.values() if each.friction for shape in each.shapes}
    return base in shapes or base.startswith(("ripple", "sensor_"))
