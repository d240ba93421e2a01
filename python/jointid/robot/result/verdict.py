"""Verdict on the use of a robot's estimate, for each purpose."""

from __future__ import annotations

from collections.abc import Iterable

from jointid.estimate.reasons_against_use import (
    EXPLAINED,
    Objection,
    explained_text,
    held_on_bounds,
)
from jointid.estimate.verdict import Verdict, concluded, to_changes, use_by
from jointid.robot.links.parameters import FRICTION
from jointid.robot.result.record import RobotEstimateRecord

_COMPENSATED = FRICTION | {"torque_offset"}
_IMPOSSIBLE = "impossible_inertia"
_BIASED = {"signal_lag", "unexamined_causes"}  # findings that bias values by an unknown amount


def judged_robot(estimate: RobotEstimateRecord) -> Verdict:
    """Judge a robot's estimate by its findings; parameters are named as in `RobotEstimate.free`.

    Not usable: a blocking finding, or a joint with less than 90 % of its windows' variance explained. For compensation
    and simulation also a friction at its bound that may exceed a tenth of its joint's friction. For simulation also
    links that are not physically consistent. Usable with care: a warning. Otherwise usable.
    """
    every = (*_objections(estimate), *_unexplained(estimate))
    objections = [each for each in every if each.code != _IMPOSSIBLE]
    names = tuple(estimate.parameters)
    bounded = [*held_on_bounds(estimate.findings, names)]
    uses = {
        "compensation": use_by([*objections, *bounded], names, _is_friction),
        "simulation": use_by([*every, *bounded], names, lambda _: True),
        "monitoring": use_by(to_changes(objections, estimate.parameters), names, lambda _: True),
    }
    # If a value is known to be biased, its standard error does not describe its accuracy.
    moved = {
        found.code
        for found in estimate.warnings
        if found.code in _BIASED or any(name.endswith(".shift") for name in found.evidence)
    }
    within = {
        purpose: size
        for purpose, size in estimate.within.items()
        if not moved & set(uses[purpose].codes)
    }
    return concluded(uses, [*every, *bounded], within)


def _objections(estimate: RobotEstimateRecord) -> Iterable[Objection]:
    for found in estimate.warnings:
        yield Objection(
            code=found.code,
            reason=found.title,
            blocking=found.severity == "blocking" or found.code == _IMPOSSIBLE,
            parameters=tuple(name for name in found.parameters if name in estimate.parameters),
        )


def _unexplained(estimate: RobotEstimateRecord) -> Iterable[Objection]:
    """Yield objections for joints with a torque that the balance does not explain."""
    for joint in estimate.joints.values():
        explained = joint.residuals.r_squared
        if joint.residuals.windows and not explained >= EXPLAINED:
            yield Objection(
                code="explained",
                reason=explained_text(explained, f"{joint.name}'s torque"),
                blocking=True,
                parameters=tuple(f"{joint.name}.{name}" for name in joint.parameters),
            )


def _is_friction(name: str) -> bool:
    return name.rpartition(".")[2] in _COMPENSATED
