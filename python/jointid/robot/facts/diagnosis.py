"""Find wrong facts one after the other, each with the previous ones corrected, and their consequences.

A wrong fact has consequences: friction held at 0, parameters that are not determined, joints that fit badly. To
separate consequences from causes, the robot is identified again with the corrected fact. Findings that then
disappear were consequences.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from jointid.base.advice import Action
from jointid.estimate.findings import Finding, Measured
from jointid.estimate.wording import percent
from jointid.recording.wide.robot_recording import RobotRecording
from jointid.robot.facts.error_candidates import ZERO, SmallError, refined, small_errors
from jointid.robot.facts.naming import named_error, named_fact, stated_zeros
from jointid.robot.facts.wrong_facts import WrongFact, wrong_fact
from jointid.robot.fit.attempt import Attempt, Request, attempted
from jointid.robot.fit.zeros import zeros_of
from jointid.robot.links.parameters import LINEAR_FRICTION
from jointid.robot.links.robot import Robot
from jointid.robot.motion.column_order import reordered
from jointid.robot.result.finding_types import TYPES, listed
from jointid.robot.result.findings import doubtful_joints

Array = NDArray[np.float64]

_ROBOT = "Robot.from_urdf"
_MOST = 3  # largest number of facts to find
_REFINED = 3  # largest number of identifications with the same fact corrected
_BETTER = 0.02  # summed fall of the joints' logarithmic residuals: a smaller fall is no correction
_SIMPLER = 0.3  # of the same: extra fall required of an error with more values
_POOR = 0.15  # of a joint's torque: with a larger residual more must be wrong


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Diagnosis:
    """Findings of an attempt, and the attempt with corrected facts."""

    findings: tuple[Finding, ...]
    recordings: Sequence[RobotRecording]  # with their columns corrected
    corrected: Attempt  # the attempt with corrected facts; the same attempt if no fact is wrong


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class _Corrected:
    """A wrong fact, and the identification with the fact corrected."""

    finding: Finding
    recordings: Sequence[RobotRecording]
    robot: Robot
    attempt: Attempt


def diagnosed(
    recordings: Sequence[RobotRecording], robot: Robot, request: Request, attempt: Attempt
) -> Diagnosis:
    """Return an attempt's findings: the wrong facts first, without findings that only follow from them.

    The recordings are on even clocks, with the torques as recorded. The robot has the facts as stated.
    """
    causes: list[Finding] = []
    last = attempt
    for turn in range(_MOST):
        turned = _with_turned_zeros(recordings, robot, request, last) if turn == 0 else None
        found = turned or _corrected(recordings, robot, request, last)
        if found is None:
            break
        causes.append(found.finding)
        recordings, robot, last = found.recordings, found.robot, found.attempt
    if not causes:
        return Diagnosis(
            findings=attempt.estimate.findings, recordings=recordings, corrected=attempt
        )
    left = {_key(each, attempt) for each in last.estimate.findings}
    stay = [each for each in attempt.estimate.findings if _key(each, attempt) in left]
    gone = [each for each in attempt.estimate.warnings if _key(each, attempt) not in left]
    every = [*causes, *_summary(causes, gone, attempt, last), *stay]
    return Diagnosis(findings=tuple(every), recordings=recordings, corrected=last)


def _with_turned_zeros(
    recordings: Sequence[RobotRecording], robot: Robot, request: Request, attempt: Attempt
) -> _Corrected | None:
    """Return the identification with other zeros than the stated ones, if quarter turns clearly fit better."""
    if robot.zero_offsets is None or not doubtful_joints(attempt.estimate):
        return None
    zeros = zeros_of(attempt.robot, list(attempt.excerpts.values()), attempt.duration)
    if not zeros.found:
        return None
    right = np.array(robot.zero_offsets) + zeros.offsets
    other = replace(robot, zero_offsets=tuple(right.tolist()))
    return _Corrected(
        finding=stated_zeros(zeros, other),
        recordings=recordings,
        robot=other,
        attempt=attempted(recordings, other, request, attempt.delay),
    )


def _corrected(
    recordings: Sequence[RobotRecording], robot: Robot, request: Request, attempt: Attempt
) -> _Corrected | None:
    """Return the fact with the best fit after its correction."""
    found = []
    small = [
        _without_error(each, recordings, robot, request, attempt) for each in small_errors(attempt)
    ]
    if small:
        left = [_misfit(each.attempt) for each in small]
        found.append(small[-1] if left[0] - left[-1] > _SIMPLER else small[0])
    suspects = doubtful_joints(attempt.estimate)
    excerpts = list(attempt.excerpts.values())
    wrong = wrong_fact(attempt.robot, excerpts, attempt.duration, suspects) if suspects else None
    if wrong is not None:
        signs = [
            _without_fact(each, recordings, robot, request, attempt)
            for each in (wrong, *wrong.others)
        ]
        # Friction dissipates power: this decides between couplings if the sign hardly shows.
        found.append(min(signs, key=lambda each: (_held(each.attempt), _misfit(each.attempt))))
    falls = [_misfit(attempt) - _misfit(each.attempt) for each in found]
    if not falls or max(falls) < _BETTER:
        return None
    return found[int(np.argmax(falls))]


def _without_error(
    error: SmallError,
    recordings: Sequence[RobotRecording],
    robot: Robot,
    request: Request,
    attempt: Attempt,
) -> _Corrected:
    for turn in range(_REFINED):
        # Quarter turns of the zeros that were found are searched again, unless a zero is wrong.
        zeros = error.robot.zero_offsets if error.kind == ZERO else robot.zero_offsets
        other = replace(error.robot, zero_offsets=zeros)
        without = attempted(recordings, other, request, attempt.delay)
        again = refined(error, without) if turn < _REFINED - 1 else None
        if again is None:
            break
        error = again
    return _Corrected(
        finding=named_error(error, robot.names),
        recordings=recordings,
        robot=other,
        attempt=without,
    )


def _without_fact(
    wrong: WrongFact,
    recordings: Sequence[RobotRecording],
    robot: Robot,
    request: Request,
    attempt: Attempt,
) -> _Corrected:
    other = replace(wrong.robot, zero_offsets=robot.zero_offsets)
    runs = [
        reordered(run, robot, wrong.order, wrong.torque_order)
        if wrong.torque_order is not None
        else run
        for run in recordings
    ]
    without = attempted(runs, other, request, attempt.delay)
    before, after = (_left(each) for each in (attempt, without))
    shown = int(np.argmax(before / after))
    measured = replace(wrong, before=float(before[shown]), after=float(after[shown]))
    return _Corrected(
        finding=named_fact(measured, robot.names[shown]),
        recordings=runs,
        robot=other,
        attempt=without,
    )


def _misfit(attempt: Attempt) -> float:
    """Return the sum of the logarithms of the joints' residuals."""
    return float(np.sum(np.log(_left(attempt))))


def _left(attempt: Attempt) -> Array:
    """Return each joint's residual over its torque."""
    left = [joint.relative_residual for joint in attempt.estimate.joints.values()]
    return np.maximum(left, 1e-6)


def _held(attempt: Attempt) -> int:
    """Return the number of friction parameters at a bound."""
    return sum(
        p.at_bound is not None
        for joint in attempt.estimate.joints.values()
        for name, p in joint.parameters.items()
        if name in LINEAR_FRICTION
    )


def _key(found: Finding, attempt: Attempt) -> tuple[str, tuple[str, ...], str]:
    """Return a key that is equal for the same finding of two attempts."""
    joint = next((name for name in attempt.robot.names if f" {name} " in f" {found.cause} "), "")
    return found.code, found.parameters, joint


def _summary(
    causes: Sequence[Finding], gone: Sequence[Finding], attempt: Attempt, last: Attempt
) -> list[Finding]:
    """Yield the consequences of wrong facts, and whether more is wrong."""
    before, after = attempt.estimate.relative_residual, last.estimate.relative_residual
    evidence = {"before": Measured(before), "after": Measured(after)}
    facts = "this fact" if len(causes) == 1 else "these facts"
    unexplained = f"{percent(before)} unexplained, {percent(after)} if corrected"
    codes = sorted({each.code for each in gone})
    found = []
    calls = [each.arguments for cause in causes for each in cause.advice if each.function == _ROBOT]
    if len(causes) > 1 and calls:
        found.append(
            TYPES["several_wrong_facts"].finding(
                f"{len(causes)} given facts are wrong ({unexplained})",
                Action("call", {k: v for each in calls for k, v in each.items()}, function=_ROBOT),
                evidence=evidence,
            )
        )
    if codes:
        found.append(
            TYPES["consequences"].finding(
                f"{len(gone)} more warnings follow from {facts} ({unexplained})",
                details=f"{', '.join(codes)}: gone when {facts} {'is' if len(causes) == 1 else 'are'} corrected",
                parameters=tuple(name for each in gone for name in each.parameters),
                evidence=evidence,
            )
        )
    poor = [name for name, joint in last.estimate.joints.items() if joint.relative_residual > _POOR]
    if poor:
        found.append(
            TYPES["more_wrong_facts"].finding(
                f"{facts} do{'es' * (len(causes) == 1)} not explain the whole residual: {listed(poor)} would still "
                "fit badly",
                Action("inspect", text=f"the given facts of {listed(poor)}"),
                evidence=evidence,
            )
        )
    return found
