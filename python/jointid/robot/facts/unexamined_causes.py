"""Joints with a residual that is not noise: its named causes, or the causes that are not examined for a robot."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from jointid.base.advice import Action
from jointid.estimate.causes import Causes
from jointid.estimate.findings import Finding, Measured
from jointid.estimate.wording import percent
from jointid.identification.causes.residual_test import slow_misfit
from jointid.robot.facts.named_causes import UNEXAMINED, cause_finding, causes_of_joint
from jointid.robot.facts.one_call import with_one_call
from jointid.robot.fit.attempt import Attempt
from jointid.robot.result.finding_types import TYPES
from jointid.robot.result.record import RobotEstimateRecord, RobotJoint

Array = NDArray[np.float64]

_FEWEST = 40  # windows
_LAGS = range(2, 9)  # windows; windows closer than that share the noise of their velocity
_FAR = 6.0  # times the median: windows with a larger residual are limited to it
_SURE = 4.5  # standard errors of an autocorrelation
_MATTERS = 0.005  # of the torque: the part of the residual that is not noise
_EXPLAINED = 0.3  # of the largest such part: corrected facts may leave this share
_MOST_LEFT = 0.5  # of a joint's residual: the causes that were found, including harmless ones, may leave this share
_MATTERS_OF_NEXT = 0.015  # the same, if only neighbouring windows are alike
_LOUD = 3.0  # residual of the slow windows over that of the others


def misfit_findings(
    attempt: Attempt, corrected: Attempt, models: Sequence[str], *, named: bool = True
) -> Iterator[Finding]:
    """Yield findings of joints with a residual that is not noise: its causes, or the causes that were not examined.

    Both limit the verdict. `models` are the requested models, one for each joint. If named wrong facts explain the
    residual, the finding is an info, because another cause may look like them. Without `named` no cause is searched,
    because known faults of the recording may look like one.
    """
    estimate = attempt.estimate
    shares = {name: _structured(joint) for name, joint in estimate.joints.items()}
    left = {name: _structured(joint) for name, joint in corrected.estimate.joints.items()}
    concerned = sorted((name for name in shares if shares[name]), key=lambda name: -shares[name])
    joints = corrected.estimate.joints.items()
    loud = [name for name, joint in joints if not shares[name] and _loud_at_low_speed(joint)]
    explained = max(left.values()) < _EXPLAINED * max(shares.values())
    told: list[Finding] = []
    harmless: list[Finding] = []
    for name in [*concerned, *loud] if named and not explained else []:
        tried = left[name] or name in loud
        causes = causes_of_joint(corrected, name) if tried else Causes(found=())
        of_joint = _all_of(estimate, name)
        told += [cause_finding(cause, name, of_joint) for cause in causes.found]
        if name not in concerned:
            continue
        harmless += [
            replace(cause_finding(cause, name, of_joint), severity="info")
            for cause in causes.harmless
        ]
        known = (*causes.found, *causes.harmless)
        if math.prod(1.0 - cause.share for cause in known) < _MOST_LEFT:
            concerned.remove(name)
    yield from with_one_call(told, estimate.robot.names, models)
    yield from harmless
    if concerned:
        left_over = {name: shares[name] for name in concerned}
        yield _unexamined(
            estimate,
            left_over,
            "the wrong facts in the other findings explain this residual" if explained else "",
        )


def _unexamined(
    estimate: RobotEstimateRecord, shares: Mapping[str, float], explained: str
) -> Finding:
    worst, *others = shares
    more = f"; {len(others)} more joint{'s' * (len(others) > 1)}" if others else ""
    every = ", ".join(f"{name} {percent(share)}" for name, share in shares.items())
    return TYPES["unexamined_causes"].finding(
        f"{percent(shares[worst])} of the torque of {worst} is neither explained nor noise{more}",
        Action(
            "inspect", text=f"{worst} identified alone: more causes are examined for a single joint"
        ),
        details="; ".join(
            filter(
                None,
                (
                    f"shares of the torque: {every}" if others else "",
                    explained,
                    UNEXAMINED,
                ),
            )
        ),
        severity="info" if explained else "warning",
        parameters=tuple(each for name in shares for each in _all_of(estimate, name)),
        evidence={name: Measured(share) for name, share in shares.items()},
    )


def _all_of(estimate: RobotEstimateRecord, name: str) -> tuple[str, ...]:
    return tuple(f"{name}.{key}" for key in estimate.joints[name].parameters)


def _structured(joint: RobotJoint) -> float:
    """Return the share of the torque in a joint's residual that depends on its own past; 0 if it is chance or small."""
    table = joint.windows
    rest = (table.measured - table.fitted) / table.duration
    count = rest.size
    if count < _FEWEST or not rest.any():
        return 0.0
    # Two windows with a large residual are alike by chance, and hide the similarity of the others: both must show it.
    most = _FAR * float(np.median(np.abs(rest)))
    both = (rest, np.clip(rest, -most, most))
    later = min(max(abs(_alike(each, lag)) for lag in _LAGS) for each in both)
    found = 0.0
    for alike, least in (
        (later, _MATTERS),
        (min(_alike(each, 1) for each in both), _MATTERS_OF_NEXT),
    ):
        share = joint.relative_residual * float(np.sqrt(max(alike, 0.0)))
        if alike > _SURE / np.sqrt(count) and share > least:
            found = max(found, share)
    return found


def _loud_at_low_speed(joint: RobotJoint) -> bool:
    """Return whether slow windows have a far larger residual; with friction there, neighbours need not be alike."""
    table = joint.windows
    slow = slow_misfit(table.measured - table.fitted, table.duration, table.velocity)
    return slow > _LOUD and joint.relative_residual > _MATTERS


def _alike(rest: Array, lag: int) -> float:
    """Return the correlation of residuals with those some windows later, between -1 and 1."""
    return float(rest[lag:] @ rest[:-lag]) / (float(rest @ rest) or 1.0)
