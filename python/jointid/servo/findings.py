"""Findings from a servo's recordings and fit."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from jointid.base.advice import Action
from jointid.estimate.causes import Causes
from jointid.estimate.findings import Finding, Measured
from jointid.estimate.wording import percent, rounded, two_digits
from jointid.identification.causes.cause_finding import finding_of_cause
from jointid.servo.estimate import ServoEstimate
from jointid.servo.finding_types import TYPES
from jointid.servo.layout import LAYOUTS, MOTOR
from jointid.servo.solving import Unknowns

_VAGUE = 0.25  # half of an interval over the value
_POOR = 0.35  # of the load's torque
_OTHER_RUNS = Action("record", text="more runs, with other gains and motions")
_RANK = {"blocking": 0, "warning": 1, "info": 2}


def findings_of(
    estimate: ServoEstimate, unknowns: Unknowns, causes: Causes | None = None
) -> tuple[Finding, ...]:
    """Return the findings, the most severe first."""
    found = [
        *_inseparable(estimate, unknowns),
        *_not_sensed(estimate),
        *_poor_fit(estimate),  # before its effects
        *_causes(estimate, causes),
        *_at_bound(estimate),
        *_vague(estimate),
    ]
    return tuple(sorted(found, key=lambda each: _RANK[each.severity]))


def _inseparable(estimate: ServoEstimate, unknowns: Unknowns) -> Iterator[Finding]:
    if unknowns.divided:
        return
    linear = estimate.parameters[unknowns.layout.linear]
    total = estimate["back_emf"] + linear.value
    yield TYPES["inseparable_back_emf"].finding(
        f"only the sum of back-EMF and {linear.meaning} is known: {total:.3g} {linear.unit}",
        Action("record", text="runs in which the torque is switched off while the load swings"),
        Action("inspect", text="the winding's resistance, and state it in the joint's drive"),
        details="the motor is always driven, so back-EMF and friction brake in the same way; k_t / R is known, k_t and "
        f"R are not; {percent(unknowns.share)} of the sum is taken as back-EMF, {_chosen(estimate)}",
        parameters=("back_emf", linear.name, *MOTOR),
        evidence={"sum": Measured(total, linear.unit)},
    )


def _chosen(estimate: ServoEstimate) -> str:
    if estimate.joint.link is None:
        return "because no load swings freely"
    return "because the free swing with this share differs least from the swings with other shares"


def _not_sensed(estimate: ServoEstimate) -> Iterator[Finding]:
    if estimate.joint.link is None:
        yield TYPES["no_known_load"].finding(
            "no load is known, so all values have one unknown common factor",
            Action("inspect", text="mass and length of the load, and state the joint's link"),
            details="the scale of the motor's torque is unknown",
            parameters=tuple(estimate.parameters),
        )


def _causes(estimate: ServoEstimate, causes: Causes | None) -> Iterator[Finding]:
    for cause in causes.found if causes is not None else ():
        names = [name for name in cause.relative if name in estimate.parameters]
        motor = MOTOR if {"torque_per_voltage", "back_emf"} & set(names) else ()
        yield finding_of_cause(cause, (*names, *motor))


def _at_bound(estimate: ServoEstimate) -> Iterator[Finding]:
    for name, p in estimate.parameters.items():
        if p.at_bound is None or name in MOTOR:
            continue
        top = p.interval[1] if p.interval is not None else np.nan
        upto = (
            f"a bootstrap over the runs gives values up to {two_digits(top)} {p.unit}".rstrip()
            if top > 0.0
            else ""
        )
        blocking = name in ("torque_per_voltage", "inertia")
        yield TYPES["at_bound"].finding(
            f"{name.replace('_', ' ')} ended at its bound 0: the runs do not show its effect",
            _OTHER_RUNS,
            details=upto,
            severity="warning" if blocking else "info",
            parameters=(name,),
            evidence={"upper": Measured(float(top), p.unit)} if np.isfinite(top) else {},
        )


def _vague(estimate: ServoEstimate) -> Iterator[Finding]:
    linear = LAYOUTS[estimate.model].linear
    for name, p in estimate.parameters.items():
        if p.stderr is None or np.isinf(p.stderr) or p.interval is None:
            continue
        # The interval also contains systematic effects: other windows, another lead, a held command.
        size = 0.5 * (p.interval[1] - p.interval[0])
        if size <= _VAGUE * abs(p.value):
            continue
        shown = f"{rounded(p.value, size)} ± {two_digits(size)} {p.unit}".rstrip()
        yield TYPES["undetermined"].finding(
            f"{name.replace('_', ' ')} is uncertain: {shown} (95 %)",
            _OTHER_RUNS,
            severity="info" if name == linear else "warning",
            parameters=(name,),
            evidence={"stderr": Measured(p.stderr, p.unit), "size": Measured(size, p.unit)},
        )


def _poor_fit(estimate: ServoEstimate) -> Iterator[Finding]:
    if estimate.relative_residual > _POOR:
        yield TYPES["poor_fit"].finding(
            f"the model does not explain {percent(estimate.relative_residual)} of the load's torque",
            Action(
                "inspect",
                text="scale and sign of the duty, the position's unit, the load, and the link's angle",
            ),
            evidence={"relative_residual": Measured(estimate.relative_residual)},
        )
