"""`identify_robot`: identify the friction of all joints and the inertia of all links together."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import replace
from typing import Unpack

from jointid import _core
from jointid.base.advice import Action
from jointid.base.argument_checks import require_kind
from jointid.base.errors import InputError
from jointid.base.options import checked, takes
from jointid.estimate.findings import Finding
from jointid.problem.settings import MaskOptions
from jointid.recording.wide.robot_recording import RobotRecording
from jointid.robot.examining import Case, examined
from jointid.robot.fit.attempt import Request
from jointid.robot.links.inertia_modes import MODES, Inertia
from jointid.robot.links.models import friction_models
from jointid.robot.links.robot import Robot
from jointid.robot.motion.request import least_speeds, recordings_of
from jointid.robot.motion.shifts import shift_option
from jointid.robot.options import RobotOptions
from jointid.robot.result.findings import ranked
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

    The torque of each joint is integrated over windows. The change of momentum and the forces of motion and gravity
    of the links are subtracted; they need positions and velocities only. The rest is friction. All joints are solved
    together, each weighted by its own residual. Velocities are derived from positions; the recorded velocity of a joint
    is used if the fit is better with it.

    Parameters
    ----------
    recordings : RobotRecording, or sequence of it
        Recordings with positions and torques, of the joints or of the motors.
    robot : Robot
    inertia : {"urdf", "scaled", "free"}
        Inertias of the links: the URDF's, the URDF's scaled link by link, or identified as base parameters, the
        combinations that motion shows. Default ``"urdf"``.
    **options

    Returns
    -------
    RobotEstimate

    Raises
    ------
    InputError
        A recording lacks a signal or a joint, or an option has an invalid value.

    Notes
    -----
    The method is the integral balance with the momentum of a tree of links: d/dt (M v) = M a + (C + Cᵀ) v, so no
    acceleration is needed. Momentum regressors of this kind are discussed for Pinocchio (pull request 2411, 2024) and
    exist in spatial_v2_extended.

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
    if robot.drive is not None and robot.drive.free and inertia != "urdf":
        raise InputError(
            "with a free gain, the URDF's links give the scale of the torque, so the links cannot be identified",
            argument="inertia",
            value=inertia,
            remedy=Action("call", {"inertia": "urdf"}, function="identify_robot"),
        )
    mask = checked(MaskOptions, options)
    request = Request(
        inertia=inertia,
        models=tuple(friction_models(options["model"], robot.names, robot.models)),
        windows=options["windows"],
        slowest=least_speeds(options["min_speed"], robot),
        **mask,
    )
    case = Case(recorded=recorded, given=robot, request=request, shift=options["shift"])
    answer = examined(case)
    attempt, estimate = answer.attempt, answer.estimate
    robot, request = attempt.robot, answer.request
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
        "recordings": [run.name for run in recorded],
    }
    return replace(
        estimate,
        robot=replace(estimate.robot, gravity_free=False),  # gravity is known now
        findings=ranked(_possible(answer.findings, case)),
        cross_check=answer.check,
        settings=settings,
        seconds=time.perf_counter() - started,
    )


def _possible(findings: Sequence[Finding], case: Case) -> list[Finding]:
    """Return findings without advice to identify the links, if the links give the scale of free gains."""
    drive = case.given.drive
    if drive is None or not drive.free:
        return [*findings]
    plain = [
        tuple(a for a in each.advice if not {"inertia"} & a.arguments.keys()) for each in findings
    ]
    return [replace(each, advice=advice) for each, advice in zip(findings, plain, strict=True)]
