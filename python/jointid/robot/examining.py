"""Identify a robot and collect findings: first the faults that spoil everything, then the fit, then its checks."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from jointid.estimate.findings import Finding
from jointid.recording.wide.robot_recording import RobotRecording
from jointid.robot.checks.cross_checking import clearer, cross_checked, disagreement, slow_motion
from jointid.robot.checks.torque_check import wrong_torques
from jointid.robot.facts.assumptions import assumption_findings
from jointid.robot.facts.asymmetry import asymmetry_findings
from jointid.robot.facts.diagnosis import Diagnosis, diagnosed
from jointid.robot.facts.naming import turned_zeros
from jointid.robot.facts.one_call import advised_models
from jointid.robot.facts.unexamined_causes import misfit_findings
from jointid.robot.fit.aligning import delay_findings
from jointid.robot.fit.attempt import Attempt, Request, attempted
from jointid.robot.fit.gravity import gravity_findings
from jointid.robot.fit.physical_inertia import impossible_links, with_possible_bodies
from jointid.robot.fit.velocity_choice import (
    VelocityChoice,
    velocity_findings,
    with_better_velocities,
)
from jointid.robot.links.inertia_modes import FREE
from jointid.robot.links.robot import Robot
from jointid.robot.motion.plain_motion import PlainSignals, plain_signals
from jointid.robot.motion.shifts import requested_delay, without_delay
from jointid.robot.motion.stamps import all_on_even_clocks
from jointid.robot.result.cross_check import CrossCheck
from jointid.robot.result.result import RobotEstimate

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True)
class Case:
    """Arguments of a call."""

    recorded: Sequence[RobotRecording]
    given: Robot
    request: Request
    shift: Any

    @property
    def delay(self) -> Array | None:
        """Delay of the torques that the call states [s]."""
        return requested_delay(self.shift, self.given)


@dataclass(frozen=True, slots=True, kw_only=True)
class Examined:
    """Identified values and their findings."""

    attempt: Attempt
    estimate: RobotEstimate
    request: Request  # with the velocities and the filter that were chosen
    check: CrossCheck
    findings: tuple[Finding, ...]


def examined(case: Case) -> Examined:
    """Identify, then check the values and the facts."""
    runs, choice = all_on_even_clocks(case.recorded), None
    if case.given.drive is not None or case.given.gravity_free:
        choice = with_better_velocities(runs, case.given, case.request, case.shift)
        # With the gains and the gravity that were found: the torques are unknown without them.
        found = choice.alignment.attempt.robot
        case = replace(case, given=replace(case.given, drive=found.drive, tree=found.tree))
    signals = _signals(
        case.recorded, case.given, None if choice is None else choice.alignment.attempt
    )
    wrong = wrong_torques(case.recorded, signals, case.given)
    if wrong is not None:
        return _blocked(case, runs, choice, wrong)
    if choice is None:
        choice = with_better_velocities(runs, case.given, case.request, case.shift)
    return _diagnosed(case, runs, choice, signals)


def _blocked(
    case: Case, runs: Sequence[RobotRecording], choice: VelocityChoice | None, wrong: Finding
) -> Examined:
    """Return the plain values. Delays and facts are not examined, because a blocking fault distorts these, too."""
    delay = np.zeros(case.given.n) if case.delay is None else case.delay
    attempt = (
        attempted(runs, case.given, case.request, delay)
        if choice is None
        else choice.alignment.attempt
    )
    assumed = assumption_findings(runs, case.given, attempt)
    return Examined(
        attempt=attempt,
        estimate=attempt.estimate,
        request=case.request,
        check=CrossCheck(reason="see the blocking finding"),
        findings=(wrong, *(each for each in assumed if each.severity == "info")),
    )


def _diagnosed(
    case: Case,
    runs: Sequence[RobotRecording],
    choice: VelocityChoice,
    signals: Sequence[PlainSignals],
) -> Examined:
    """Return the values with the better velocities and delays, and findings from facts, cross-check and residuals."""
    attempt, request = choice.alignment.attempt, choice.alignment.request
    estimate = attempt.estimate
    if request.inertia == FREE:
        estimate = with_possible_bodies(estimate, attempt.fit)
    diagnosis = diagnosed(runs, case.given, request, attempt)
    check = _second_look(case, runs, attempt, diagnosis, request, signals)
    findings = (
        *assumption_findings(runs, case.given, attempt),
        *velocity_findings(choice, case.given),
        *delay_findings(choice.alignment),
        *gravity_findings(case.given, attempt),
        *diagnosis.findings,
        *impossible_links(estimate),
    )
    plain = all(each.severity == "info" for each in findings) and check.agrees is not False
    # Any other fault can cause a difference of the directions, too.
    rest = [*asymmetry_findings(attempt)] if plain else []
    if not rest:
        late = any(each.code == "signal_lag" for each in findings)  # a delay looks like friction
        corrected = diagnosis.corrected
        rest = [*misfit_findings(attempt, corrected, request.models, named=not late)]
    if check.agrees is False and not check.explained:
        better = _with_advised_models(diagnosis, request, rest)
        if better is not None:
            other = _signals(diagnosis.recordings, diagnosis.corrected.robot, better)
            again = cross_checked(other, better, request, case.delay)
            check = replace(check, explained=bool(again.agrees))
    findings = (*disagreement(check, slow_motion(signals)), *findings, *rest)
    if attempt.zeros is not None and attempt.zeros.found:
        findings = (*findings, turned_zeros(attempt.zeros, attempt.robot))
    return Examined(
        attempt=attempt, estimate=estimate, request=request, check=check, findings=findings
    )


def _second_look(
    case: Case,
    runs: Sequence[RobotRecording],
    attempt: Attempt,
    diagnosis: Diagnosis,
    request: Request,
    signals: Sequence[PlainSignals],
) -> CrossCheck:
    """Return the cross-check on recorded stamps, on the even clock if that is clearer, and with corrected facts."""
    check = cross_checked(signals, attempt, request, case.delay)
    if check.agrees is False and any(a is not b for a, b in zip(runs, case.recorded, strict=True)):
        even = cross_checked(_signals(runs, case.given, attempt), attempt, request, case.delay)
        check = clearer(check, even)
    if check.agrees is False and diagnosis.corrected is not attempt:
        corrected = diagnosis.corrected
        other = _signals(diagnosis.recordings, corrected.robot, corrected)
        again = cross_checked(other, corrected, request, case.delay)
        check = replace(check, explained=bool(again.agrees))
    return check


def _with_advised_models(
    diagnosis: Diagnosis, request: Request, findings: Sequence[Finding]
) -> Attempt | None:
    """Return the identification with corrected facts and the models that findings advise; None if they advise none."""
    richer, last = advised_models(findings), diagnosis.corrected
    if not richer:
        return None
    names = last.robot.names
    models = tuple(richer.get(*each) for each in zip(names, request.models, strict=True))
    return attempted(diagnosis.recordings, last.robot, replace(request, models=models), last.delay)


def _signals(
    recordings: Sequence[RobotRecording], robot: Robot, attempt: Attempt | None
) -> list[PlainSignals]:
    """Return the recorded signals to check. With a drive, its delay is applied, because the torques depend on it."""
    if robot.drive is not None and attempt is not None:
        recordings = [without_delay(run, robot, attempt.delay) for run in recordings]
    return plain_signals(recordings, robot)
