"""The verdict: whether the values of an estimate may be used, and for which purposes."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import field, replace
from typing import TYPE_CHECKING, Any, Literal

from jointid.base.errors import InputError
from jointid.base.values import dataclass
from jointid.estimate.reasons_against_use import (
    Objection,
    acts_against_motion,
    hidden_inertia,
    no_values,
    objections_of,
    without_friction,
)
from jointid.estimate.wording import percent

if TYPE_CHECKING:
    from jointid.estimate.record import EstimateRecord
    from jointid.estimate.self_test import SelfTest
    from jointid.estimate.statistics import ParameterEstimate

Level = Literal["usable", "usable with care", "not usable"]
LEVELS: tuple[Level, ...] = ("usable", "usable with care", "not usable")
# Findings that affect a comparison of two recordings of the same motion: random errors, and effects that change
# between recordings. A constant bias does not matter.
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
_NAMED = 5  # parameters named in a text
_SEEN = 0.036  # relative standard error at which a change of 10 % is detected (95 %)


@dataclass(frozen=True, slots=True, kw_only=True)
class Use:
    """Usability of an estimate for one purpose.

    Attributes
    ----------
    level : {"usable", "usable with care", "not usable"}
    parameters : tuple of str
        Parameters that need care or prevent the use; empty if the reason is not about single parameters.
    codes : tuple of str
        Codes of the findings that are the reason, and "explained", "self_test" or "given".
    within : float or None
        Largest relative error (95 %) of the quantities that the purpose needs, from `Estimate.within`. None if the
        estimate is not usable, or the error is unknown.
    """

    level: Level
    parameters: tuple[str, ...] = ()
    codes: tuple[str, ...] = ()
    within: float | None = field(default=None, repr=False)

    def __str__(self) -> str:
        more = len(self.parameters) - _NAMED
        names = ", ".join(self.parameters[:_NAMED]) + (f" and {more} more" if more > 0 else "")
        named = f" ({names})" if names else ""
        return f"{self.level}{named}"

    @property
    def how_good(self) -> str:
        """Accuracy as a clause, e.g. ", to ± 9 %"; empty if unknown."""
        if self.within is None:
            return ""
        return f", to ± {percent(self.within)}" if self.within < 1.0 else ", worse than ± 100 %"


@dataclass(frozen=True, slots=True, kw_only=True)
class Verdict:
    """Usability of an estimate's values.

    Attributes
    ----------
    level : {"usable", "usable with care", "not usable"}
        Worst level of all purposes.
    reasons : tuple of str
        Reasons against use without care, one sentence each, most severe first.
    uses : mapping of str to Use
        Purpose → usability. "compensation": friction compensation in a controller (friction and sensor parameters).
        "simulation": all parameters. "monitoring": changes of 10 % between recordings of the same motion; a constant
        bias does not matter.
    """

    level: Level
    reasons: tuple[str, ...]
    uses: Mapping[str, Use]

    def __str__(self) -> str:
        if len({(use.level, use.parameters) for use in self.uses.values()}) == 1:
            return str(next(iter(self.uses.values())))
        return "; ".join(f"for {purpose}: {use}" for purpose, use in self.uses.items())

    def lines(self) -> list[str]:
        """Return the verdict as text: one line, and one per purpose if they differ or have an accuracy."""
        alike = len({(use.level, use.parameters) for use in self.uses.values()}) == 1
        first = f"verdict: {self if alike else self.level}"
        if alike and not any(use.how_good for use in self.uses.values()):
            return [first]
        return [first, *(f"  {name}: {use}{use.how_good}" for name, use in self.uses.items())]

    def document(self) -> dict[str, Any]:
        """Return the verdict in JSON's types."""
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


def judged(
    estimate: EstimateRecord, self_test: SelfTest | None = None, parameters: Iterable[str] = ()
) -> Verdict:
    """Judge an estimate by its findings.

    Not usable for any purpose, if

    - a finding is blocking,
    - a requested parameter fails the self-test, or
    - the model and the causes in findings explain less than 90 % of the windows' variance. If held-out torque chose
      the model, the variance of that torque counts. Neither counts if the windows are explained worse than by their
      mean, and the residual is more than 10 % of their squares.

    Not usable for compensation and simulation, if a parameter that they need has no value:

    - it is on its bound, with a warning `at_bound`,
    - it has no finite error, with a finding `undetermined`, or
    - it is a friction with a finding `undetermined`, and its error may be half of its value and a tenth of all
      friction.

    If friction differs by direction, offset and directional Coulomb friction are exempt: no motion can separate them,
    and no purpose needs it.

    Not usable for simulation, if an inertia is on its bound, or is undetermined with a 95 % interval that reaches zero.
    Not usable for compensation, if the torque contains no friction.

    Usable with care, if there is a warning, or if a tolerance of the stated facts exceeds 5 % and all other errors
    together. Otherwise usable.

    Parameters
    ----------
    estimate : Estimate
    self_test : SelfTest, optional
        Self-test of the estimate. Default: none.
    parameters : iterable of str
        Requested parameters. Default: all free parameters.

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
    for name in asked:  # an unknown name would never get an objection
        if name not in estimate.parameters:
            raise InputError(
                f"the estimate has no such parameter; choose one of {', '.join(estimate.parameters)}",
                argument="parameters",
                value=name,
            )
    held = (name for name, p in estimate.parameters.items() if p.at_bound is not None)
    asked = asked or (*estimate.free, *held)
    objections = [*objections_of(estimate, self_test)]
    merged = [*no_values(estimate, asked)]
    absent = [*without_friction(estimate)]
    hidden = [*merged, *hidden_inertia(estimate, asked)]
    uses = {
        "compensation": use_by([*objections, *merged, *absent], asked, acts_against_motion),
        "simulation": use_by([*objections, *hidden], asked, lambda _: True),
        "monitoring": use_by(to_changes(objections, estimate.parameters), asked, lambda _: True),
    }
    return concluded(uses, [*objections, *hidden, *absent], estimate.within)


def to_changes(
    objections: Iterable[Objection], parameters: Mapping[str, ParameterEstimate]
) -> Iterable[Objection]:
    """Yield the objections to detecting a change of 10 % between two recordings of the same motion."""
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


def concluded(
    uses: Mapping[str, Use], objections: Iterable[Objection], within: Mapping[str, float]
) -> Verdict:
    """Return the verdict of these uses: the worst level, the accuracies, and the reasons, causes first."""
    uses = {
        purpose: use if use.level == "not usable" else replace(use, within=within.get(purpose))
        for purpose, use in uses.items()
    }
    level = max((use.level for use in uses.values()), key=LEVELS.index)
    ordered = sorted(objections, key=lambda each: each.rank)
    return Verdict(level=level, reasons=tuple(each.reason for each in ordered), uses=uses)


def use_by(
    objections: Iterable[Objection], asked: tuple[str, ...], needed: Callable[[str], bool]
) -> Use:
    """Return the level from objections to a purpose's parameters; objections without parameters affect all.

    If an objection blocks all parameters, none is named, because the others would seem right.
    """
    level: Level = "usable"
    names: dict[str, None] = {}
    codes: dict[str, None] = {}
    of_all = False
    for each in objections:
        concerned = [name for name in each.parameters if name in asked and needed(name)]
        if each.parameters and not concerned and not (each.blocking and each.code != "self_test"):
            continue
        codes[each.code] = None
        names.update(dict.fromkeys(concerned))
        of_all |= each.blocking and not each.parameters
        reached: Level = "not usable" if each.blocking else "usable with care"
        level = max(level, reached, key=LEVELS.index)
    return Use(level=level, parameters=() if of_all else tuple(names), codes=tuple(codes))
