"""Findings from a robot's recording and fit."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

import numpy as np

from jointid.base.advice import Action
from jointid.estimate.findings import Finding, Measured
from jointid.estimate.reasons_against_use import LARGE
from jointid.estimate.statistics import distance_from_bound
from jointid.estimate.wording import percent, rounded, two_digits
from jointid.identification.inference.purposes import Torques
from jointid.robot.balance.inertia import InertiaColumns
from jointid.robot.links.inertia_modes import FREE
from jointid.robot.links.models import linear_terms
from jointid.robot.links.parameters import LINEAR_FRICTION, POSITION_GAIN
from jointid.robot.result.finding_types import TYPES, listed
from jointid.robot.result.record import RobotEstimateRecord, RobotJoint

_STANDING = 0.1  # of the time: a larger share is reported
_MOSTLY = 0.35
_VAGUE = 0.25  # standard error over value: above it, a value is uncertain
# difference of a link's scale from 1, and its ratio to the standard error
_MATTERS, _SURE = 0.05, 3.0
_POOR = 0.15  # of the torque
_DOUBTFUL = 0.05  # of the torque: above it, the facts should be checked
_LEFT_OUT = "this part of the motion does not show friction and is left out"
_RANK = {"blocking": 0, "warning": 1, "info": 2}


def findings_of(
    estimate: RobotEstimateRecord, columns: InertiaColumns, torques: Mapping[str, Torques]
) -> tuple[Finding, ...]:
    """Return an estimate's findings, the most severe first; `torques` are by the parameters' names."""
    found = [
        *_standing(estimate),
        *(
            each
            for joint in estimate.joints.values()
            for each in _of_joint(joint, estimate, torques[joint.name])
        ),
        *_of_inertia(estimate, columns),
    ]
    return ranked(found)


def ranked(findings: Iterable[Finding]) -> tuple[Finding, ...]:
    """Return findings with the most severe first, and warnings with a correcting call before other warnings."""

    def rank(found: Finding) -> tuple[int, bool]:
        called = any(each.kind == "call" for each in found.advice)
        return _RANK[found.severity], found.severity == "warning" and not called

    return tuple(sorted(findings, key=rank))


def doubtful_joints(estimate: RobotEstimateRecord) -> list[int]:
    """Return joints with a large residual or negative friction, which shows that a fact may be wrong."""
    return [
        number
        for number, joint in enumerate(estimate.joints.values())
        if joint.relative_residual > _DOUBTFUL
        or any(joint.parameters[term.name].at_bound == "min" for term in linear_terms(joint.model))
    ]


def _standing(estimate: RobotEstimateRecord) -> Iterator[Finding]:
    """Yield findings of joints that hardly move, one by one, and one finding of joints that sometimes stand still."""
    shares = {name: joint.residuals.standing for name, joint in estimate.joints.items()}
    for name, share in shares.items():
        if share > _MOSTLY:
            yield TYPES["standing"].finding(
                f"{name} stands still, sticks or is too slow {percent(share)} of the time",
                Action("record", text=f"more motion of {name}"),
                details=_LEFT_OUT,
                parameters=_all_of(estimate.joints[name]),
                evidence={"left_out": Measured(share)},
            )
    some = {name: share for name, share in shares.items() if _STANDING < share <= _MOSTLY}
    if some:
        most = max(some, key=lambda name: some[name])
        yield TYPES["standing"].finding(
            f"joints stand still, stick or are too slow, most often {most}: {percent(some[most])} of the time",
            details=f"{', '.join(f'{name} {percent(share)}' for name, share in some.items())}; {_LEFT_OUT}",
            severity="info",
            evidence={name: Measured(share) for name, share in some.items()},
        )


def _of_joint(
    joint: RobotJoint, estimate: RobotEstimateRecord, torques: Torques
) -> Iterator[Finding]:
    for name in (*LINEAR_FRICTION, POSITION_GAIN):
        p = joint.parameters.get(name)
        if p is None or p.stderr is None or p.stderr <= _VAGUE * abs(p.value):
            continue
        if torques.is_nothing(p):
            continue
        what = f"{name.replace('_', ' ')} of {joint.name}"
        known = np.isfinite(p.stderr)
        yield TYPES["undetermined"].finding(
            f"{what} is uncertain: {rounded(p.value, p.stderr)} ± {two_digits(p.stderr)} {p.unit}"
            if known
            else f"{what} is not determined: any value fits the recording",
            Action("record", text=f"more and faster motion of {joint.name}"),
            parameters=(f"{joint.name}.{name}",),
            evidence={"stderr": Measured(p.stderr, p.unit)} if known else {},
        )
    held = [name for name in LINEAR_FRICTION if name in joint.parameters]
    held = [name for name in held if joint.parameters[name].at_bound is not None]
    held_by = {
        name: torques.of_all_friction(name, distance_from_bound(joint.parameters[name]))
        for name in held
    }
    for small in (False, True):
        alike = [name for name, share in held_by.items() if (share <= LARGE) == small]
        if alike:
            largest = percent(max(held_by[name] for name in alike))
            names = listed([name.replace("_", " ") for name in alike])
            what = f"{names} of {joint.name} {'is' if len(alike) == 1 else 'are'}"
            yield TYPES["at_bound"].finding(
                f"{what} held at the bound 0; the true value is at most {largest} of the joint's friction"
                if small
                else f"{what} held at 0 instead of a negative value",
                *(() if small else (_looked_at(joint),)),
                details="" if small else "the model or a stated fact is wrong",
                severity="info" if small else "warning",
                parameters=tuple(f"{joint.name}.{name}" for name in alike),
                evidence={f"{joint.name}.{name}.share": Measured(held_by[name]) for name in alike},
            )
    residual = joint.relative_residual
    if residual > _POOR:
        freed = Action("call", {"inertia": FREE}, function="identify_robot")
        yield TYPES["poor_fit"].finding(
            f"{percent(residual)} of the torque of {joint.name} stays unexplained",
            *(() if estimate.inertia == FREE else (freed,)),
            _looked_at(joint),
            parameters=_all_of(joint),
            evidence={"relative_residual": Measured(residual)},
        )


def _looked_at(joint: RobotJoint) -> Action:
    return Action("inspect", text=f"unit, sign and gear ratio of {joint.name}")


def _all_of(joint: RobotJoint) -> tuple[str, ...]:
    return tuple(f"{joint.name}.{name}" for name in joint.parameters)


def _of_inertia(estimate: RobotEstimateRecord, columns: InertiaColumns) -> Iterator[Finding]:
    names = estimate.robot.names
    if columns.dropped:
        shown = listed([names[each] for each in columns.dropped])
        yield TYPES["merged_inertia"].finding(
            f"the rotor inertia of {shown} is part of the links' inertias",
            details="no motion separates these inertias; the base parameters contain the rotor inertia",
        )
    if columns.fixed:
        shown = listed([names[each] for each in columns.fixed])
        yield TYPES["merged_inertia"].finding(
            f"the scale of the link that {shown} moves stays at 1",
            Action("call", {"rotor_inertias": ...}, function="Robot.from_urdf"),
            details="no motion separates this scale from rotor inertias and other scales",
        )
    if estimate.consistent is False:
        yield TYPES["impossible_inertia"].finding(
            "the inertial parameters of some links are not physically consistent",
            Action("call", {"inertia": FREE}, function="identify_robot"),
            details="no bodies can have such parameters; friction and the torque of motion may still be right",
        )
    for joint in estimate.joints.values():
        scale = joint.parameters.get("inertia_scale")
        if scale is not None and scale.stderr and _far(scale.value, scale.stderr):
            size = f"{rounded(scale.value, scale.stderr)} ± {two_digits(scale.stderr)}"
            yield TYPES["scaled_inertia"].finding(
                f"the link that {joint.name} moves has {size} times the URDF's inertia",
                parameters=(f"{joint.name}.inertia_scale",),
                evidence={"scale": Measured(scale.value), "stderr": Measured(scale.stderr)},
            )


def _far(scale: float, stderr: float) -> bool:
    """Return whether a scale differs from 1 by more than its error and by a relevant amount."""
    return abs(scale - 1.0) > max(_MATTERS, _SURE * stderr)
