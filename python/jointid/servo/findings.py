"""What a servo's recordings and fit show."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from jointid.base.advice import Action
from jointid.estimate.findings import Finding, Measured
from jointid.estimate.wording import percent, two_digits
from jointid.servo.estimate import ServoEstimate
from jointid.servo.solving import Sought

_VAGUE = 0.25  # half of an interval, of the value
_MOTOR = ("back_emf", "viscous", "torque_constant", "resistance")
_POOR = 0.35  # of the load's torque
_RANK = {"blocking": 0, "warning": 1, "info": 2}


def findings_of(estimate: ServoEstimate, sought: Sought) -> tuple[Finding, ...]:
    """Return the findings, the most severe first.

    Parameters
    ----------
    estimate : ServoEstimate
    sought : Sought
    """
    found = [
        *_inseparable(estimate, sought),
        *_not_sensed(estimate),
        *_at_bound(estimate),
        *_vague(estimate),
        *_poor_fit(estimate),
    ]
    return tuple(sorted(found, key=lambda each: _RANK[each.severity]))


def _inseparable(estimate: ServoEstimate, sought: Sought) -> Iterator[Finding]:
    if sought.divided:
        return
    total = estimate["back_emf"] + estimate["viscous"]
    yield Finding(
        code="inseparable_back_emf",
        parameters=_MOTOR,
        evidence={"sum": Measured(total, "N·m·s/rad")},
        title="the motor is driven throughout, so back-EMF and viscous friction brake alike and only their sum, "
        f"{total:.3g} N·m·s/rad, is known: k_t and R are not identifiable, only k_t / R; {percent(sought.share)} of "
        f"the sum is taken as back-EMF, {_chosen(estimate)}",
        advice=(
            Action("record", text="runs in which the torque is switched off while the load swings"),
            Action("inspect", text="the winding's resistance, and state it in the joint's drive"),
        ),
    )


def _chosen(estimate: ServoEstimate) -> str:
    if estimate.joint.link is None:
        return "for want of a load that swings"
    return "whose free swing is nearest to those of all other shares, at worst"


def _not_sensed(estimate: ServoEstimate) -> Iterator[Finding]:
    if estimate.joint.link is None:
        yield Finding(
            code="no_known_load",
            severity="blocking",
            parameters=tuple(estimate.parameters),
            title="no load is known, so nothing says how large the motor's torque is: all values have an unknown "
            "factor",
            advice=(
                Action("inspect", text="mass and length of the load, and state the joint's link"),
            ),
        )


def _at_bound(estimate: ServoEstimate) -> Iterator[Finding]:
    for name, p in estimate.parameters.items():
        if p.at_bound is None or name in ("torque_constant", "resistance"):
            continue
        top = p.interval[1] if p.interval is not None else np.nan
        upto = (
            f"; runs drawn anew give up to {two_digits(top)} {p.unit}".rstrip() if top > 0.0 else ""
        )
        blocking = name in ("torque_per_voltage", "inertia")
        yield Finding(
            code="at_bound",
            severity="warning" if blocking else "info",
            parameters=(name,),
            evidence={"upper": Measured(float(top), p.unit)} if np.isfinite(top) else {},
            title=f"{name.replace('_', ' ')} ended on its bound 0: the runs show none{upto}",
        )


def _vague(estimate: ServoEstimate) -> Iterator[Finding]:
    for name, p in estimate.parameters.items():
        if p.stderr is None or np.isinf(p.stderr) or p.interval is None:
            continue
        # The interval has what chance does not make: other windows, another lead, a held command.
        size = 0.5 * (p.interval[1] - p.interval[0])
        if size <= _VAGUE * abs(p.value):
            continue
        yield Finding(
            code="undetermined",
            severity="info" if name == "viscous" else "warning",
            parameters=(name,),
            evidence={"stderr": Measured(p.stderr, p.unit), "size": Measured(size, p.unit)},
            title=f"{name.replace('_', ' ')} may be off by {two_digits(size)} {p.unit}".rstrip()
            + f" (half of its 95 % interval); its value is {two_digits(p.value)}",
            advice=(Action("record", text="more runs, with other gains and motions"),),
        )


def _poor_fit(estimate: ServoEstimate) -> Iterator[Finding]:
    if estimate.relative_residual > _POOR:
        yield Finding(
            code="poor_fit",
            evidence={"relative_residual": Measured(estimate.relative_residual)},
            title=f"the model leaves {percent(estimate.relative_residual)} of the load's torque",
            advice=(
                Action(
                    "inspect", text="scale and sign of the duty, the load, and the link's angle"
                ),
            ),
        )
