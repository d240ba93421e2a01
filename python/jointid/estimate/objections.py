"""What speaks against the use of an estimate, as its findings say it."""

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

EXPLAINED = 0.9  # of the variance of windows, at least
_MATTERS = 0.05  # of a value: a smaller tolerance does not matter
LARGE = 0.1
"""Of all friction: a part of it that may be so much more or less is not known."""
_HALF = 0.5  # of a value: what may be off by more is not known
# What follows from a cause, and names none.
_SYMPTOMS = frozenset(
    (
        *("explained", "self_test", "at_bound", "model_too_rich", "few_windows", "poor_fit"),
        *("structured_residual", "given", "errors"),
    )
)
_MOST = 0.5  # of a misfit: its cause goes before what follows from it


@dataclass(frozen=True, slots=True, kw_only=True)
class Objection:
    """One reason against a use.

    Attributes
    ----------
    code : str
        Code of the finding.
    reason : str
        In a sentence.
    blocking : bool
        Whether the values cannot be used.
    parameters : tuple of str
        Those concerned; empty where all are.
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
        """Its place among the reasons: causes before what follows from them, what blocks before what does not."""
        cause = self.code not in _SYMPTOMS
        if self.blocking and cause:
            return 0
        if cause and self.share > _MOST:
            return 1
        return 2 if self.blocking else 3


def objections_of(estimate: EstimateRecord, self_test: SelfTest | None) -> Iterable[Objection]:
    """Yield what findings, the misfit, a self-test and the given facts' tolerances say."""
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
    """Return how much of a variance the model explains."""
    share = f"{100.0 * explained:.0f} %" if explained > 0.005 else "nothing"
    return f"the model explains {share} of the variance of {of_what}"


def no_values(estimate: EstimateRecord, asked: tuple[str, ...]) -> Iterable[Objection]:
    """Friction and sensor's values that are none: on a bound, or a part of a sum that nothing in the recording divides.

    Where friction differs by direction, an offset is one quantity with it for any motion, and need not be separated.
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
            reason=f"compensation and simulation need {' and '.join(merged)}, but this recording determines no "
            f"single value of them{sums}",
            blocking=True,
            parameters=merged,
        )


def held_on_bounds(findings: Iterable[Finding], asked: Collection[str]) -> Iterable[Objection]:
    """Friction on its bound that may be more than a tenth of all friction."""
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
    """A torque that holds no friction: of that compensation alone knows nothing."""
    for found in estimate.findings:
        if _is_of_compensation(found):
            yield Objection(
                code=found.code,
                reason=found.title,
                blocking=True,
                parameters=_free(estimate, found),
            )


def _is_of_compensation(found: Finding) -> bool:
    """Whether a finding speaks against compensation alone: a friction of 0 is a good value of a joint without any."""
    return found.code == "no_friction" and found.severity == "warning"


def _is_split(p: ParameterEstimate, share: float) -> bool:
    """Whether only a sum with it is known: it may be off by any amount, or by half of it and much of all friction.

    `share` is half of its interval, of all friction.
    """
    if p.stderr is not None and math.isinf(p.stderr):
        return True
    half = 0.0 if p.interval is None else 0.5 * (p.interval[1] - p.interval[0])
    return share > LARGE and half > _HALF * abs(p.value)


def hidden_inertia(estimate: EstimateRecord, asked: tuple[str, ...]) -> Iterable[Objection]:
    """An inertia of which the recording says nothing: friction and offsets may be zero, what moves has an inertia."""
    doubted = _named(estimate.findings, "undetermined")
    for name, p in estimate.parameters.items():
        if name.partition("[")[0] != "inertia":
            continue
        if p.at_bound is not None:  # such a one is not among the free ones
            yield Objection(
                code="at_bound",
                reason=f"a simulation needs {name}, which ended on its bound",
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
    """What warnings of this code name, with their shares of all friction as far as they say them."""
    return {
        name: found.evidence[key].value if (key := f"{name}.share") in found.evidence else 0.0
        for found in findings
        if found.code == code and found.severity != "info"
        for name in found.parameters
    }


def _free(estimate: EstimateRecord, found: Finding) -> tuple[str, ...]:
    return tuple(name for name in found.parameters if name in estimate.parameters)


def _named_share(estimate: EstimateRecord) -> float:
    """How much of the misfit a finding has a cause for: the finding says what that moves, so it needs care alone."""
    shares = [
        found.evidence["share"].value
        for found in estimate.findings
        if found.severity == "warning" and found.parameters and "share" in found.evidence
    ]
    return min(1.0, max(0.0, *shares)) if shares else 0.0


def _explained(estimate: EstimateRecord) -> tuple[float, str]:
    """Share of the variance that the model explains, of held-out torque where there is some.

    That torque does not excuse a reading that the model misses: the two do not belong together, e.g. because one of
    them is late. A reading that hardly varies may be explained worse than by its mean, but little of it is left.
    """
    left = estimate.residuals
    if estimate.selection is not None and not _missed(estimate):
        chosen = estimate.selection[estimate.selection.model]
        if math.isfinite(chosen.score):
            return 1.0 - chosen.score * chosen.score, "the held-out torque"
    return left.r_squared, "the windows"


def _missed(estimate: EstimateRecord) -> bool:
    """Whether what was measured is missed altogether: a cause's name excuses no such values."""
    left = estimate.residuals
    return left.r_squared < 0.0 and left.relative**2 > 1.0 - EXPLAINED


def _rests_on_given(p: ParameterEstimate) -> bool:
    given = p.systematic.get("given", 0.0)
    others = [size for name, size in p.systematic.items() if name != "given"]
    return given > max(math.hypot(p.stderr or 0.0, *others), _MATTERS * abs(p.value))


def acts_against_motion(name: str) -> bool:
    """Whether a controller that compensates friction needs a parameter: it needs no inertia and no weight."""
    base = name.partition("[")[0]
    rows = {row.name: row for row in _core.terms()}
    row = rows.get(base)
    if row is not None and not row.family:
        return bool(row.friction) or base.startswith("sensor_")
    shapes = {shape for each in rows.values() if each.friction for shape in each.shapes}
    return base in shapes or base.startswith(("ripple", "sensor_"))
