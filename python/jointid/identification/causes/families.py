"""Table of the causes of a residual, one row each, for a joint, a robot's joint and a servo.

A new cause needs a row here and a function in `candidates`. All other code takes name, meaning, size and advice from
this table.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import TYPE_CHECKING

from jointid import _core
from jointid.base.advice import Action
from jointid.base.values import dataclass
from jointid.estimate.delays import Delay
from jointid.estimate.types_of_findings import FindingType
from jointid.identification.causes import candidates as of
from jointid.identification.causes import low_speed, sizes
from jointid.identification.causes.candidates import Candidate
from jointid.identification.causes.fitted_balance import FILTERED, FittedBalance

if TYPE_CHECKING:
    from jointid.identification.causes.attributed import Attributed

_HALF = 0.2  # sample periods; a torque that is early by 0.5 ± this is probably held between samples
_HELD = Action(
    "call", {"torque_hold": "zoh"}, text="if the torque is a command that is held between samples"
)
_EARLY = "the sampling times of torque and position, and the backlash"
_SLOW = (
    Action(
        "record", text="motion that passes zero speed quickly, and slow motion in another recording"
    ),
)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Family:
    """One cause.

    Attributes
    ----------
    name : str
        Name of the cause, and code of its finding.
    meaning : str
        Description of the cause, as the beginning of a sentence.
    remedy : str
        General advice for tables of findings.
    candidates : callable
        Function that yields the candidates of the cause; none if the balance cannot show it. Several causes may share a
        function; the names of its candidates distinguish them. Default: the cause is found without columns.
    advice : callable
        Function that returns actions against a found cause.
    size : callable
        Function that returns the `Size` of the cause, with the directly measured delays. Default: by the
        candidate's unit.
    changes : callable
        Function that returns parameters that the cause changes directly, with their shifts: a coefficient that varies
        shifts by half its range. Default: none.
    """

    name: str
    meaning: str
    remedy: str
    candidates: Callable[[FittedBalance], Iterator[Candidate]] = of.nothing
    advice: Callable[[FittedBalance, Attributed], tuple[Action, ...]]
    size: Callable[[FittedBalance, Attributed, Mapping[str, Delay]], sizes.Size] = sizes.by_unit
    changes: Callable[[FittedBalance, Attributed], dict[str, float]] = lambda *_: {}

    @property
    def finding_type(self) -> FindingType:
        """Finding type of the cause."""
        return FindingType(
            code=self.name,
            meaning=f"{self.meaning} explains the residual on held-out data. Info: the cause hardly changes the values",
            advice=self.remedy,
            picture="windows",
        )


def _always(*actions: Action) -> Callable[..., tuple[Action, ...]]:
    """Return an advice function with the same actions for every fit."""
    return lambda *_: actions


def _with_order(fit: FittedBalance, field: str, cause: Attributed) -> tuple[Action, ...]:
    """Advise to identify with one more order."""
    orders = (*fit.orders.get(field, ()), float(cause.candidate.detail))
    return fit.identified_with(**{field: orders})


def _against_another_law(fit: FittedBalance, cause: Attributed) -> tuple[Action, ...]:
    """Advise to compare with the first model that has the term."""
    of_it = [term.key for term in of.other_laws() if term.meaning == cause.candidate.detail]
    models = [model.name for model in _core.models() if set(of_it) & set(model.terms)]
    return fit.compared_with(name=models[0]) if models else ()


def _against_asymmetry(fit: FittedBalance, _: Attributed) -> tuple[Action, ...]:
    """Advise to compare with an asymmetric model, unless a sensor offset looks the same."""
    if "sensor_offset" in fit.names:
        return (Action("inspect", text="the friction in each direction"),)
    return fit.compared_with(asymmetric=True)


def against_delay(fit: FittedBalance, cause: Attributed) -> tuple[Action, ...]:
    """Advise to set that the torque is held, or to inspect the delay."""
    detail = cause.candidate.detail
    if detail == FILTERED:
        return (Action("call", {"columns": {"velocity": None}}, function="load"),)
    early = -float(cause.coefficients[0]) / fit.sample_period
    look = Action("inspect", text=f"when the {detail} is sampled, and when it is logged")
    if detail == "torque" and early > 0.0:  # a torque cannot be early
        look = Action("inspect", text=_EARLY)
    unheld = detail == "torque" and not fit.torque_held
    return (_HELD, look) if unheld and abs(early - 0.5) < _HALF else (look,)


def _against_slow_motion(fit: FittedBalance, _: Attributed) -> tuple[Action, ...]:
    """Advise to compare with the next richer friction model, if there is one."""
    name = fit.model_name
    richer = {"coulomb_viscous": "stribeck", "stribeck": "stribeck_general"}.get(name)
    if richer is None or (richer == "stribeck_general" and fit.is_asymmetric):
        return _SLOW
    return (*fit.compared_with(name=richer), *_SLOW)


OTHER_LAW = Family(
    name="other_law",
    meaning="friction of another model",
    remedy="use a model that has this friction",
    candidates=of.other_law,
    advice=_against_another_law,
)

FAMILIES: tuple[Family, ...] = (
    Family(
        name="gravity",
        meaning="gravity that the model lacks",
        remedy="also identify gravity: `stribeck:gravity=free`",
        candidates=of.gravity,
        advice=lambda fit, _: fit.identified_with(gravity="free"),
        size=sizes.amplitude,
    ),
    Family(
        name="inertia_varies",
        meaning="inertia that varies with the angle",
        remedy="record motion about one pose",
        candidates=of.inertia_varies,
        advice=_always(
            Action("record", text="motion about one pose, or with smaller acceleration"),
            Action("inspect", text="whether other joints change the inertia"),
        ),
        size=sizes.range_of,
        changes=lambda fit, cause: (
            {"inertia": sizes.half_range(fit, cause)} if "inertia" in fit.names else {}
        ),
    ),
    Family(
        name="load_friction",
        meaning="friction that grows with the load",
        remedy="add load_friction to the model",
        candidates=of.load_friction,
        advice=lambda fit, _: fit.compared_with(load_friction=True),
        size=sizes.of_the_load,
    ),
    Family(
        name="slow_motion",
        meaning="low-speed friction that the model lacks",
        remedy="use the model stribeck",
        candidates=low_speed.slow_motion,
        advice=_against_slow_motion,
    ),
    Family(
        name="smooth_friction",
        meaning="friction that rises smoothly with speed",
        remedy="use the model smooth_coulomb_viscous",
        candidates=low_speed.smooth_friction,
        advice=lambda fit, _: fit.compared_with(name=low_speed.smooth_law()[0]),
    ),
    Family(
        name="presliding",
        meaning="friction that builds up after each reversal",
        remedy="record longer strokes with fewer reversals",
        candidates=low_speed.slow_motion,
        advice=_always(
            Action("record", text="longer strokes with fewer reversals"),
            Action("inspect", text="the friction just after each reversal"),
        ),
    ),
    Family(
        name="stribeck_exponent",
        meaning="low-speed friction with another Stribeck exponent",
        remedy="use the model stribeck_general, which has a free exponent",
        candidates=low_speed.slow_motion,
        advice=_against_slow_motion,
    ),
    Family(
        name="drift",
        meaning="drift of a coefficient",
        remedy="record after warming up, or identify the first and the last part of the log separately",
        candidates=of.drift,
        advice=_always(
            Action("record", text="after warming up"),
            Action("inspect", text="the values of the first and the last part of the recording"),
        ),
        size=sizes.drift_of,
        changes=sizes.drifts,
    ),
    Family(
        name="harmonic",
        meaning="torque that depends on the angle",
        remedy="add harmonics of the named order to the model",
        candidates=of.harmonic,
        advice=lambda fit, cause: _with_order(fit, "harmonics", cause),
        size=sizes.over_angle("angle"),
    ),
    Family(
        name="ripple",
        meaning="torque that depends on the motor angle",
        remedy="add ripple of the named order to the model",
        candidates=of.ripple,
        advice=lambda fit, cause: _with_order(fit, "ripple", cause),
        size=sizes.over_angle("motor angle"),
    ),
    Family(
        name="delay",
        meaning="a late or early signal",
        remedy="correct the time stamps of this signal",
        candidates=of.delay,
        advice=against_delay,
        size=sizes.lateness,
    ),
    Family(
        name="asymmetry",
        meaning="friction that differs between directions",
        remedy="identify the friction of each direction: `stribeck:asymmetric`",
        candidates=of.asymmetry,
        advice=_against_asymmetry,
        changes=lambda fit, cause: (
            {"viscous": float(cause.coefficients[0])} if "viscous" in fit.names else {}
        ),
    ),
    Family(
        name="offset",
        meaning="constant torque that the model lacks",
        remedy="add torque_offset to the joint",
        candidates=of.offset,
        advice=lambda fit, _: fit.with_offset(),
        size=sizes.constant,
    ),
    Family(
        name="wrong_scale",
        meaning="known inertia that does not fit the torque",
        remedy="check gear ratio, torque constant and inertia",
        candidates=of.wrong_scale,
        advice=_always(Action("inspect", text="gear ratio, torque constant and inertia")),
        size=sizes.scale,
        changes=sizes.scaled,
    ),
    Family(
        name="other_signal",
        meaning="torque that follows another signal",
        remedy="record while all other axes are at rest",
        candidates=of.other_signal,
        advice=_always(Action("record", text="while everything else is at rest")),
    ),
    Family(
        name="other_run",
        meaning="a recording with different values",
        remedy="compare the unit, sign, zero and load of this recording with the others; identify this recording alone",
        candidates=of.other_run,
        advice=_always(
            Action(
                "inspect",
                text="units, signs, zero position, load and temperature of that recording",
            ),
            Action("inspect", text="the values from each recording alone"),
        ),
    ),
    Family(
        name="disturbance",
        meaning="a short disturbance",
        remedy="cut the disturbance out of the recording",
        advice=_always(
            Action("record", text="without contact"),
            Action("inspect", text="what happened at that time"),
        ),
        size=sizes.constant,
    ),
    # This row does not exist if other causes cover all friction terms.
    *((OTHER_LAW,) if of.other_laws() else ()),
)

BY_NAME = {family.name: family for family in FAMILIES}


def listed_candidates(fit: FittedBalance, only: str = "") -> list[Candidate]:
    """Return all candidates that the model lacks and the recordings can show, or only those of one cause."""
    families = FAMILIES if only == "" else (BY_NAME[only],)
    makers = dict.fromkeys(family.candidates for family in families)
    return [each for maker in makers for each in maker(fit) if each.columns.any()]


def same_candidate(fit: FittedBalance, wanted: Candidate) -> Candidate | None:
    """Return the same candidate for another fit of the same recordings; None for ripple in sums of windows."""
    of_its_name = (
        each for each in BY_NAME[wanted.name].candidates(fit) if each.name == wanted.name
    )
    return next((each for each in of_its_name if each.detail == wanted.detail), None)
