"""`identify_robot`: the friction of all joints at once, with the inertia of all links."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import replace
from typing import Unpack

import numpy as np

from jointid import _core
from jointid.base.argument_checks import require_kind
from jointid.base.errors import InputError
from jointid.base.options import checked, takes
from jointid.problem.settings import MaskOptions
from jointid.recording.wide.robot_recording import RobotRecording
from jointid.robot.checks.cross_checking import cross_checked, disagreement, slow_motion
from jointid.robot.checks.torque_check import wrong_torques
from jointid.robot.facts.assumptions import assumption_findings
from jointid.robot.facts.asymmetry import asymmetry_findings
from jointid.robot.facts.diagnosis import diagnosed
from jointid.robot.facts.naming import turned_zeros
from jointid.robot.facts.one_call import advised_models
from jointid.robot.facts.unexamined_causes import misfit_findings
from jointid.robot.fit.aligning import aligned, delay_findings
from jointid.robot.fit.attempt import Attempt, Request, attempted
from jointid.robot.fit.gravity import gravity_findings
from jointid.robot.fit.physical_inertia import impossible_links, with_possible_bodies
from jointid.robot.fit.velocity_choice import velocity_findings, with_better_velocities
from jointid.robot.links.inertia_modes import FREE, MODES, Inertia
from jointid.robot.links.models import friction_models
from jointid.robot.links.robot import Robot
from jointid.robot.motion.plain_motion import PlainSignals, plain_signals
from jointid.robot.motion.request import least_speeds, recordings_of
from jointid.robot.motion.shifts import requested_delay, shift_option, without_delay
from jointid.robot.motion.stamps import all_on_even_clocks
from jointid.robot.options import RobotOptions
from jointid.robot.result.cross_check import CrossCheck
from jointid.robot.result.findings import RANK
from jointid.robot.result.result import RobotEstimate


@takes(RobotOptions)
def identify_robot(
    recordings: RobotRecording | Sequence[RobotRecording],
    robot: Robot,
    *,
    inertia: Inertia = "urdf",
    **options: Unpack[RobotOptions],
) -> RobotEstimate:
    """Identify the friction of a robot's joints from recordings of all of them, without accelerations.

    The torque of each joint is integrated over windows. So is what moves the links and holds them against gravity:
    the change of the joints' momenta, and the forces of motion and gravity, which need positions and velocities only.
    The rest is friction. All joints are solved at once, each weighted by its own residual. Velocities are
    derived from the positions, or a joint's is taken from the recording where the balance is better with it.

    Parameters
    ----------
    recordings : RobotRecording, or sequence of it
        With positions and torques, of the joints or of the motors.
    robot : Robot
    inertia : {"urdf", "scaled", "free"}
        Whether the links' inertias are those of the URDF, scaled link by link, or identified: as base parameters,
        the combinations that motion shows. Default ``"urdf"``.
    **options

    Returns
    -------
    RobotEstimate

    Raises
    ------
    InputError
        A recording lacks a signal or a joint, or an option has no such value.

    Notes
    -----
    The integral balance with the momentum of a tree of links: d/dt (M v) = M a + (C + Cᵀ) v, so that no acceleration
    is needed; momentum regressors of that kind are discussed for Pinocchio (pull request 2411, 2024) and exist in
    spatial_v2_extended.

    Examples
    --------
    >>> robot = jid.Robot.from_urdf("arm.urdf")
    >>> found = jid.identify(jid.load("arm.csv", joints="all"), robot, inertia="free")
    >>> [*found.joints], found.joints["elbow"].parameters["coulomb"].unit
    (['shoulder', 'elbow'], 'N·m')
    """
    started = time.perf_counter()
    require_kind("robot", robot, Robot)
    recorded = recordings_of(recordings)
    if inertia not in MODES:
        raise InputError(
            f"one of {', '.join(MODES)} is expected", argument="inertia", value=inertia
        )
    mask = checked(MaskOptions, options)
    request = Request(
        inertia=inertia,
        models=tuple(friction_models(options["model"], robot.names, robot.models)),
        windows=options["windows"],
        slowest=least_speeds(options["min_speed"], robot),
        **mask,
    )
    shift = options["shift"]
    stated_delay = requested_delay(shift, robot)
    runs, given = all_on_even_clocks(recorded), robot
    first = None
    if robot.drive is not None or robot.gravity_free:
        first = aligned(runs, robot, request, shift)
        # With the gains and the gravity that were found, without which nobody knows the torques.
        given = replace(robot, drive=first.attempt.robot.drive, tree=first.attempt.robot.tree)
    signals = _signals(recorded, given, None if first is None else first.attempt)
    wrong = wrong_torques(recorded, signals, given)
    if (
        wrong is not None
    ):  # neither delays nor facts are tried: all that they show would follow from this
        attempt = (
            attempted(
                runs, robot, request, np.zeros(robot.n) if stated_delay is None else stated_delay
            )
            if first is None
            else first.attempt
        )
        estimate, check = attempt.estimate, CrossCheck(reason="see the blocking finding")
        assumed = assumption_findings(runs, given, attempt)
        findings = (wrong, *(each for each in assumed if each.severity == "info"))
    else:
        choice = None
        if first is None:
            choice = with_better_velocities(runs, robot, request, shift)
            found = choice.alignment
        else:
            found = first
        request = found.request
        attempt = found.attempt
        estimate = attempt.estimate
        if inertia == FREE:
            estimate = with_possible_bodies(estimate, attempt.fit)
        diagnosis = diagnosed(runs, given, request, attempt)
        check = cross_checked(signals, attempt, request, stated_delay)
        if check.agrees is False and diagnosis.corrected is not attempt:
            corrected = diagnosis.corrected
            other = _signals(diagnosis.recordings, corrected.robot, corrected)
            again = cross_checked(other, corrected, request, stated_delay)
            check = replace(check, explained=bool(again.agrees))
        findings = (
            *assumption_findings(runs, given, attempt),
            *([] if choice is None else velocity_findings(choice, robot)),
            *delay_findings(found),
            *gravity_findings(robot, attempt),
            *diagnosis.findings,
            *impossible_links(estimate),
        )
        plain = all(each.severity == "info" for each in findings) and check.agrees is not False
        # With another finding, a difference of the directions may follow from that.
        uneven = [*asymmetry_findings(attempt)] if plain else []
        late = any(each.code == "signal_lag" for each in findings)  # a delay looks like friction
        rest = uneven or [
            *misfit_findings(attempt, diagnosis.corrected, request.models, named=not late)
        ]
        richer = advised_models(rest)
        if check.agrees is False and not check.explained and richer:
            wanted = [richer.get(*each) for each in zip(given.names, request.models, strict=True)]
            last = diagnosis.corrected
            better = attempted(
                diagnosis.recordings,
                last.robot,
                replace(request, models=tuple(wanted)),
                last.delay,
            )
            other = _signals(diagnosis.recordings, last.robot, better)
            again = cross_checked(other, better, request, stated_delay)
            check = replace(check, explained=bool(again.agrees))
        findings = (*disagreement(check, slow_motion(signals)), *findings, *rest)
        if attempt.zeros is not None and attempt.zeros.found:
            findings = (*findings, turned_zeros(attempt.zeros, attempt.robot))
    robot = attempt.robot
    settings = {
        "model": {name: joint.model for name, joint in estimate.joints.items()},
        "inertia": inertia,
        "window_duration": attempt.duration,
        "zero_offsets": list(robot.zero_offsets or (0.0,) * robot.n),
        "min_speed": [float(each) for each in request.slowest],
        **mask,
        "shift": shift_option(attempt.delay, robot, request.lag),
        "recorded_velocity": [robot.names[joint] for joint in request.recorded],
        "version": _core.__version__,
        "recordings": [run.name for run in runs],
    }
    return replace(
        estimate,
        findings=tuple(sorted(findings, key=lambda each: RANK[each.severity])),
        cross_check=check,
        settings=settings,
        seconds=time.perf_counter() - started,
    )


def _signals(
    recordings: Sequence[RobotRecording], robot: Robot, attempt: Attempt | None
) -> list[PlainSignals]:
    """What is checked, as recorded; of a drive with the command's delay: without it, nobody knows the torques."""
    if robot.drive is not None and attempt is not None:
        recordings = [without_delay(run, robot, attempt.delay) for run in recordings]
    return plain_signals(recordings, robot)
