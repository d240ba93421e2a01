"""Verdict on the use of a servo's estimate, for each purpose."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from jointid.estimate.reasons_against_use import EXPLAINED, Objection, explained_text
from jointid.estimate.verdict import Verdict, concluded, to_changes, use_by
from jointid.servo.layout import LOAD_FRICTION, SPEED_FRICTION
from jointid.servo.record import ServoEstimateRecord

_COMPENSATED = {"torque_per_voltage", *(term.name for term in (*SPEED_FRICTION, LOAD_FRICTION))}


def judged_servo(estimate: ServoEstimateRecord) -> Verdict:
    """Judge a servo's estimate by its findings.

    Not usable: a blocking finding, or less than 90 % of the load's squared torque explained. Also a value at its bound
    with a warning of `at_bound`, for purposes that need this value. Usable with care: a warning, or no errors
    (``draws=0``). Otherwise usable. Compensation needs friction and the parameters that convert a torque into a duty.
    Simulation needs all values.
    """
    objections = [*_objections(estimate)]
    names = tuple(estimate.parameters)
    bounded = [replace(each, blocking=True) for each in objections if each.code == "at_bound"]
    needed = [each for each in bounded if _COMPENSATED.intersection(each.parameters)]
    uses = {
        "compensation": use_by([*objections, *needed], names, _COMPENSATED.__contains__),
        "simulation": use_by([*objections, *bounded], names, lambda _: True),
        "monitoring": use_by(to_changes(objections, estimate.parameters), names, lambda _: True),
    }
    return concluded(uses, objections, {})


def _objections(estimate: ServoEstimateRecord) -> Iterable[Objection]:
    for found in estimate.warnings:
        yield Objection(
            code=found.code,
            reason=found.title,
            blocking=found.severity == "blocking",
            parameters=tuple(name for name in found.parameters if name in estimate.parameters),
        )
    free = [p for p in estimate.parameters.values() if p.vary and p.at_bound is None]
    if free and all(p.stderr is None for p in free):
        yield Objection(
            code="errors",
            reason="errors were not requested, so the accuracy of the values is not known",
            blocking=False,
            parameters=tuple(p.name for p in free),
        )
    explained = 1.0 - estimate.relative_residual**2
    if not explained >= EXPLAINED:
        yield Objection(
            code="explained",
            reason=explained_text(explained, "the load's torque"),
            blocking=True,
            parameters=(),
        )
