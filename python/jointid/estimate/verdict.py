"""Whether the numbers of an estimate may be used, and for what."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import field, replace
from typing import TYPE_CHECKING, Any, Literal

from jointid.base.errors import InputError
from jointid.base.values import dataclass
from jointid.estimate.objections import (
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
_NAMED = 5  # parameters, in words
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
        Codes of the findings behind it, and "explained", "self_test" or "given".
    within : float or None
        How far off what it needs may be at most (95 %), as a share of it: of `Estimate.within`. None where it does not
        serve, or where that is not known.
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


def judged(
    estimate: EstimateRecord, self_test: SelfTest | None = None, parameters: Iterable[str] = ()
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
        Self-test of this estimate. Default: none.
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


def concluded(
    uses: Mapping[str, Use], objections: Iterable[Objection], within: Mapping[str, float]
) -> Verdict:
    """Return the verdict of these uses: the worst level, how good they are, and the reasons, the cause first."""
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
    """Return the level by what concerns the parameters that a purpose needs; without parameters it concerns all.

    Where something blocks all, none is named: it would look as if the others were right.
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
