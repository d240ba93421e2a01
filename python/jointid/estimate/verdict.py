"""Whether the numbers of an estimate may be used, and for what."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import field, replace
from typing import TYPE_CHECKING, Any, Literal

from jointid import _core
from jointid.base.errors import InputError
from jointid.base.values import dataclass
from jointid.estimate.derived import sums_of_splits
from jointid.estimate.wording import percent, two_digits

if TYPE_CHECKING:
    from jointid.estimate.estimate import Estimate
    from jointid.estimate.findings import Finding
    from jointid.estimate.self_test import SelfTest
    from jointid.estimate.statistics import ParameterEstimate

Level = Literal["usable", "usable with care", "not usable"]
LEVELS: tuple[Level, ...] = ("usable", "usable with care", "not usable")
EXPLAINED = 0.9  # of the variance of windows, at least
_MATTERS = 0.05  # of a value: a smaller tolerance does not matter
# What spoils a change between two recordings of the same motion, other than a bias that stays the same: chance, and
# what is not the same the next time.
_CHANCE = frozenset(
    ("standing", "undetermined", "few_windows", "stopped", "at_bound", "model_too_rich")
)
_CHANGING = frozenset(
    (
        "drift",
        "disturbance",
        "other_signal",
        "spikes",
        "jumps",
        "sensor_clipped",
        "torque_saturated",
    )
)
_SPLIT = 0.1  # of all friction: a part of it that may be so much more or less,
_HALF = 0.5  # and so much of its value, is not known
# What follows from a cause, and names none.
_SYMPTOMS = frozenset(
    (
        *("explained", "self_test", "at_bound", "model_too_rich", "few_windows", "poor_fit"),
        *("structured_residual", "given", "errors"),
    )
)
_MOST = 0.5  # of a misfit: its cause goes before what follows from it
_SEEN = 0.036  # standard error, of a value: with it a change of a tenth is seen, at 95 %


@dataclass(frozen=True, slots=True, kw_only=True)
class Use:
    """Whether an estimate serves one purpose.

    Attributes
    ----------
    level : {"usable", "usable with care", "not usable"}
    parameters : tuple of str
        Those to mind, or because of which it does not serve; empty where it is not about single ones.
    codes : tuple of str
        Of the findings that say so, and "explained", "self_test" or "given".
    within : float or None
        How far off what it needs may be at most (95 %), as a share of it: of `Estimate.within`. None where it does not
        serve, or where that is not known.
    """

    level: Level
    parameters: tuple[str, ...] = ()
    codes: tuple[str, ...] = ()
    within: float | None = field(default=None, repr=False)

    def __str__(self) -> str:
        named = f" ({', '.join(self.parameters)})" if self.parameters else ""
        return f"{self.level}{named}"

    @property
    def how_good(self) -> str:
        """How well it serves as a clause, e.g. ", to ± 9 %"; empty where that is not known."""
        if self.within is None:
            return ""
        return f", to ± {percent(self.within)}" if self.within < 1.0 else ", worse than ± 100 %"


@dataclass(frozen=True, slots=True, kw_only=True)
class Verdict:
    """Whether the numbers of an estimate may be used.

    Attributes
    ----------
    level : {"usable", "usable with care", "not usable"}
        The worst of all purposes.
    reasons : tuple of str
        Why not without care, in a sentence each, the most severe first.
    uses : mapping of str to Use
        By purpose: "compensation" (of friction in a controller: its friction and sensor parameters), "simulation"
        (all parameters), "monitoring" (changes of a tenth between recordings of the same motion, which a bias that
        stays the same does not spoil).
    """

    level: Level
    reasons: tuple[str, ...]
    uses: Mapping[str, Use]

    def __str__(self) -> str:
        if len({(use.level, use.parameters) for use in self.uses.values()}) == 1:
            return str(next(iter(self.uses.values())))
        return "; ".join(f"for {purpose}: {use}" for purpose, use in self.uses.items())

    def lines(self) -> list[str]:
        """The verdict as text: one line, and one for each purpose where they differ or say how good they are."""
        alike = len({(use.level, use.parameters) for use in self.uses.values()}) == 1
        first = f"verdict: {self if alike else self.level}"
        if alike and not any(use.how_good for use in self.uses.values()):
            return [first]
        return [first, *(f"  {name}: {use}{use.how_good}" for name, use in self.uses.items())]

    def document(self) -> dict[str, Any]:
        """The verdict, of JSON's types."""
        return {
            "level": self.level,
            "reasons": list(self.reasons),
            "uses": {
                purpose: {
                    "level": use.level,
                    "parameters": list(use.parameters),
                    "codes": list(use.codes),
                    "within": use.within,
                }
                for purpose, use in self.uses.items()
            },
        }


@dataclass(frozen=True, slots=True, kw_only=True)
class Objection:
    """One reason against a use.

    Attributes
    ----------
    code : str
        Of the finding.
    reason : str
        In a sentence.
    blocking : bool
        Whether the values cannot be used.
    parameters : tuple of str
        Those concerned; empty where all are.
    share : float
        Of the misfit, what it is the cause of. Default 0.
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


def judged(
    estimate: Estimate, self_test: SelfTest | None = None, parameters: Iterable[str] = ()
) -> Verdict:
    """Judge an estimate by its findings.

    Not usable: a blocking finding, a parameter asked for whose self-test fails, or less than 90 % of the windows'
    variance explained by the model and a cause that a finding names (of held-out torque where the model was chosen by
    it; neither counts where the windows are explained worse than by their mean and more than 10 % of their squares
    are left); for compensation and simulation also a parameter that they need and that is no value: one on its bound
    that `at_bound` warns of, one without a finite error that `undetermined` names (where friction differs by
    direction, offset and directional Coulomb frictions have none for any motion, and need none), or a friction that
    `undetermined` names and that may be off by half of its value and a tenth of all friction; for simulation also an
    inertia on its bound, or an undetermined one whose 95 % interval reaches zero; for compensation alone a torque
    that holds no friction.
    Usable with care: a warning, or a tolerance of the given facts of more than 5 % that is larger than everything
    else together. Usable: else.

    Parameters
    ----------
    estimate : Estimate
    self_test : SelfTest, optional
        Of this estimate. Default: it is judged without one.
    parameters : iterable of str
        Those asked for. Default: all that are free.

    Returns
    -------
    Verdict

    Raises
    ------
    InputError
        The estimate has no such parameter.

    Examples
    --------
    >>> str(jid.identify(recording, joint, model="stribeck").verdict)
    'usable'
    """
    asked = (parameters,) if isinstance(parameters, str) else tuple(parameters)
    for name in asked:  # nothing is ever said against a name that is not there
        if name not in estimate.parameters:
            raise InputError(
                f"the estimate has no such parameter; it has {', '.join(estimate.parameters)}",
                argument="parameters",
                value=name,
            )
    held = (name for name, p in estimate.parameters.items() if p.at_bound is not None)
    asked = asked or (*estimate.free, *held)
    objections = [*_objections(estimate, self_test)]
    merged = [*_no_values(estimate, asked)]
    absent = [*_without_friction(estimate)]
    hidden = [*merged, *_hidden_inertia(estimate, asked)]
    uses = {
        "compensation": use_by([*objections, *merged, *absent], asked, _acts_against_motion),
        "simulation": use_by([*objections, *hidden], asked, lambda _: True),
        "monitoring": use_by(to_changes(objections, estimate.parameters), asked, lambda _: True),
    }
    served = {
        purpose: replace(use, within=estimate.within.get(purpose))
        for purpose, use in uses.items()
        if use.level != "not usable"
    }
    return concluded(uses | served, [*objections, *hidden, *absent])


def to_changes(
    objections: Iterable[Objection], parameters: Mapping[str, ParameterEstimate]
) -> Iterable[Objection]:
    """Yield what spoils a change of a tenth between two recordings of the same motion."""
    for each in objections:
        if each.code == "undetermined" and not each.blocking:
            vague = tuple(name for name in each.parameters if not _is_sharp(parameters[name]))
            if vague or not each.parameters:
                yield Objection(
                    code=each.code, reason=each.reason, blocking=False, parameters=vague
                )
        elif each.blocking or each.code in _CHANCE | _CHANGING:
            yield each


def _is_sharp(p: ParameterEstimate) -> bool:
    return p.stderr is not None and p.stderr <= _SEEN * abs(p.value)


def concluded(uses: Mapping[str, Use], objections: Iterable[Objection]) -> Verdict:
    """Return the verdict of these uses: the worst level, and the reasons, the cause first."""
    level = max((use.level for use in uses.values()), key=LEVELS.index)
    ordered = sorted(objections, key=lambda each: each.rank)
    return Verdict(level=level, reasons=tuple(each.reason for each in ordered), uses=uses)


def use_by(
    objections: Iterable[Objection], asked: tuple[str, ...], needed: Callable[[str], bool]
) -> Use:
    """Return the level by what concerns the parameters that a purpose needs; without parameters it concerns all."""
    level: Level = "usable"
    names: dict[str, None] = {}
    codes: dict[str, None] = {}
    for each in objections:
        concerned = [name for name in each.parameters if name in asked and needed(name)]
        if each.parameters and not concerned and not (each.blocking and each.code != "self_test"):
            continue
        codes[each.code] = None
        names.update(dict.fromkeys(concerned))
        reached: Level = "not usable" if each.blocking else "usable with care"
        level = max(level, reached, key=LEVELS.index)
    return Use(level=level, parameters=tuple(names), codes=tuple(codes))


def _objections(estimate: Estimate, self_test: SelfTest | None) -> Iterable[Objection]:
    for found in estimate.findings:
        if found.severity != "info" and not _is_of_compensation(found):
            yield Objection(
                code=found.code,
                reason=found.cause,
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
            reason=f"known values of {', '.join(self_test.lost)} in the recorded motion are not found again",
            blocking=True,
            parameters=self_test.lost,
        )
    given = tuple(p.name for p in estimate.parameters.values() if _rests_on_given(p))
    if given:
        names = ", ".join(given)
        reason = f"what is stated of the joint is more uncertain than all else that {names} rest on"
        yield Objection(code="given", reason=reason, blocking=False, parameters=given)


def explained_text(explained: float, of_what: str) -> str:
    """Return how much of a variance the model explains."""
    share = f"{100.0 * explained:.0f} %" if explained > 0.005 else "nothing"
    return f"the model explains {share} of the variance of {of_what}"


def _no_values(estimate: Estimate, asked: tuple[str, ...]) -> Iterable[Objection]:
    """Friction and sensor's values that are none: on a bound, or a part of a sum that nothing in the recording divides.

    Where friction differs by direction, an offset is one quantity with it for any motion, and need not be separated.
    """
    bounded = _named(estimate, "at_bound")
    needed = tuple(name for name, share in bounded.items() if name in asked and share > _SPLIT)
    if needed:
        yield Objection(
            code="at_bound",
            reason=f"compensation and simulation need {' and '.join(needed)}, which ended on a bound: that is no value",
            blocking=True,
            parameters=needed,
        )
    doubted = _named(estimate, "undetermined")
    merged = tuple(
        name
        for name, share in doubted.items()
        if name in asked
        and _acts_against_motion(name)
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
            reason=f"compensation and simulation need {' and '.join(merged)}, of which this recording determines no "
            f"single value{sums}",
            blocking=True,
            parameters=merged,
        )


def _is_of_compensation(found: Finding) -> bool:
    """Whether a finding speaks against compensation alone: a friction of 0 is a good value of a joint without any."""
    return found.code == "no_friction" and found.severity == "warning"


def _without_friction(estimate: Estimate) -> Iterable[Objection]:
    for found in estimate.findings:
        if _is_of_compensation(found):
            yield Objection(
                code=found.code,
                reason=found.cause,
                blocking=True,
                parameters=_free(estimate, found),
            )


def _is_split(p: ParameterEstimate, share: float) -> bool:
    """Whether only a sum with it is known: it may be off by any amount, or by half of it and much of all friction.

    `share` is half of its interval, of all friction.
    """
    if p.stderr is not None and math.isinf(p.stderr):
        return True
    half = 0.0 if p.interval is None else 0.5 * (p.interval[1] - p.interval[0])
    return share > _SPLIT and half > _HALF * abs(p.value)


def _hidden_inertia(estimate: Estimate, asked: tuple[str, ...]) -> Iterable[Objection]:
    """An inertia of which the recording says nothing: friction and offsets may be zero, what moves has an inertia."""
    doubted = _named(estimate, "undetermined")
    for name, p in estimate.parameters.items():
        if name.partition("[")[0] != "inertia":
            continue
        if p.at_bound is not None:  # such a one is not among the free ones
            yield Objection(
                code="at_bound",
                reason=f"a simulation needs {name}, and it ended on its bound",
                blocking=True,
                parameters=(name,),
            )
        elif name in asked and name in doubted and p.interval is not None and p.interval[0] <= 0.0:
            yield Objection(
                code="undetermined",
                reason=f"a simulation needs {name}, and its 95 % interval reaches zero",
                blocking=True,
                parameters=(name,),
            )


def _named(estimate: Estimate, code: str) -> dict[str, float]:
    """Parameters that a warning of this code names, with their shares of all friction as far as it says them."""
    return {
        name: found.evidence[key].value if (key := f"{name}.share") in found.evidence else 0.0
        for found in estimate.findings
        if found.code == code and found.severity != "info"
        for name in _free(estimate, found)
    }


def _free(estimate: Estimate, found: Finding) -> tuple[str, ...]:
    return tuple(name for name in found.parameters if name in estimate.parameters)


def _named_share(estimate: Estimate) -> float:
    """How much of the misfit a finding has a cause for: the finding says what that moves, so it needs care alone."""
    shares = [
        found.evidence["share"].value
        for found in estimate.findings
        if found.severity == "warning" and found.parameters and "share" in found.evidence
    ]
    return min(1.0, max(0.0, *shares)) if shares else 0.0


def _explained(estimate: Estimate) -> tuple[float, str]:
    """Share of the variance that the model explains, of held-out torque where there is some.

    That torque does not excuse a reading that the model misses: the two do not belong together, e.g. because one of
    them is late. A reading that hardly varies may be explained worse than by its mean, but little of it is left.
    """
    left = estimate.residuals
    if estimate.selection is not None and not _missed(estimate):
        chosen = estimate.selection[estimate.selection.model]
        if math.isfinite(chosen.score):
            return 1.0 - chosen.score**2, "the held-out torque"
    return left.r_squared, "the windows"


def _missed(estimate: Estimate) -> bool:
    """Whether what was measured is missed altogether: a cause's name excuses no such values."""
    left = estimate.residuals
    return left.r_squared < 0.0 and left.relative**2 > 1.0 - EXPLAINED


def _rests_on_given(p: ParameterEstimate) -> bool:
    given = p.systematic.get("given", 0.0)
    others = [size for name, size in p.systematic.items() if name != "given"]
    return given > max(math.hypot(p.stderr or 0.0, *others), _MATTERS * abs(p.value))


def _acts_against_motion(name: str) -> bool:
    """Whether a controller that compensates friction needs a parameter: it needs no inertia and no weight."""
    base = name.partition("[")[0]
    rows = {row.name: row for row in _core.terms()}
    row = rows.get(base)
    if row is not None and not row.family:
        return bool(row.friction) or base.startswith("sensor_")
    shapes = {shape for each in rows.values() if each.friction for shape in each.shapes}
    return base in shapes or base.startswith(("ripple", "sensor_"))
