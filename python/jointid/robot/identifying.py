"""`identify_robot`: the friction of all joints at once, with the inertia of all links."""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.base.argument_checks import require_kind
from jointid.base.errors import InputError
from jointid.joint.model import Model
from jointid.recording.wide.robot_recording import RobotRecording
from jointid.robot.balance import Balance, balance_of
from jointid.robot.choice import certainty, with_static
from jointid.robot.conclusion import concluded
from jointid.robot.decays import Decays, solved_with_decays
from jointid.robot.findings import doubtful_joints, named_fact, turned_zeros, wrong_inertias
from jointid.robot.fit import Fit
from jointid.robot.inertia import MODES, SCALED, URDF, inertia_columns
from jointid.robot.models import AUTO, PLAIN, friction_models
from jointid.robot.motion import Motion
from jointid.robot.result import RobotEstimate
from jointid.robot.robot import Robot
from jointid.robot.solving import covariance_of, solved, time_segments
from jointid.robot.wrong_facts import wrong_fact
from jointid.robot.zeros import zeros_of

Array = NDArray[np.float64]

_LONGEST = 0.1  # [s]: longer windows blur reversals and leave few


def identify_robot(
    recordings: RobotRecording | Sequence[RobotRecording],
    robot: Robot,
    *,
    inertia: str = "urdf",
    model: Model | str | Mapping[str, Model | str] | None = None,
    windows: float | None = None,
    min_speed: float | Sequence[float] | Mapping[str, float] | None = None,
    mask_standstill: bool = True,
) -> RobotEstimate:
    """Identify the friction of a robot's joints from recordings of all of them, without accelerations.

    The torque of each joint is integrated over windows. So is what moves the links and holds them against gravity:
    the change of the joints' momenta, and the forces of motion and gravity, which need positions and velocities only.
    The rest is friction. All joints are solved at once, each weighted by its own residual. Velocities are always
    derived from the positions.

    Parameters
    ----------
    recordings : RobotRecording, or sequence of it
        With positions and torques, of the joints or of the motors.
    robot : Robot
    inertia : {"urdf", "scaled", "free"}
        Whether the links' inertias are those of the URDF, scaled link by link, or identified: as base parameters,
        the combinations that motion shows. Default ``"urdf"``.
    model : Model, str or mapping, optional
        Friction of the joints: "coulomb_viscous", "stribeck", or "auto" (default): each joint has static friction if
        that predicts its held-out torque better. A mapping from joints' names to models says it for some of them.
    windows : float, optional
        Duration of the windows [s]. Default: what the velocities' noise asks for, at most 0.1 s.
    min_speed : float, sequence or mapping of float, optional
        Speed below which a joint's balance is left out [rad/s or m/s]; one for all, one a joint, or by name.
        Default 0.
    mask_standstill : bool
        Whether to leave out where a joint stands still. Default True.

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
    >>> robot = jid.Robot.from_urdf("arm.urdf")  # doctest: +SKIP
    >>> found = jid.identify_robot(jid.load_robot("arm.csv"), robot, inertia="free")  # doctest: +SKIP
    >>> found.joints["joint_1"].parameters["coulomb"].value  # doctest: +SKIP
    7.1
    """
    started = time.perf_counter()
    require_kind("robot", robot, Robot)
    runs = _runs(recordings)
    if inertia not in MODES:
        raise InputError(
            f"one of {', '.join(MODES)} is expected", argument="inertia", value=inertia
        )
    models = friction_models(model, robot)
    slowest = _least_speeds(min_speed, robot)
    motions = [Motion.of(run, robot, slowest, mask_standstill) for run in runs]
    duration = _duration(windows, motions)
    zeros = None if robot.zero_offsets is not None else zeros_of(robot, motions, duration)
    if zeros is not None and zeros.found:
        robot = replace(robot, zero_offsets=zeros.offsets)
        shift = np.array(zeros.offsets)[:, None]
        motions = [replace(each, position=each.position + shift) for each in motions]
    balance = balance_of(robot, motions, duration)
    if not balance.rows.torque.size:
        raise InputError("no joint moves", argument="recordings", value=runs[0].name)
    estimate = _solved(robot, balance, inertia, duration, models)
    settings = {
        "model": {name: joint.model for name, joint in estimate.joints.items()},
        "inertia": inertia,
        "window_duration": duration,
        "zero_offsets": list(robot.zero_offsets or (0.0,) * robot.n),
        "min_speed": [float(each) for each in slowest],
        "mask_standstill": mask_standstill,
        "version": _core.__version__,
        "recordings": [run.name for run in runs],
    }
    findings = estimate.findings
    if zeros is not None and zeros.found:
        findings = (turned_zeros(zeros, robot), *findings)
    if inertia == URDF:
        scaled = _solved(robot, balance, SCALED, duration, models)
        findings = (*wrong_inertias(estimate, scaled), *findings)
    suspects = doubtful_joints(estimate)
    wrong = wrong_fact(robot, motions, duration, suspects) if suspects else None
    if wrong is not None:
        findings = (named_fact(wrong), *findings)
    return replace(
        estimate,
        findings=findings,
        settings=settings,
        seconds=time.perf_counter() - started,
    )


def _solved(
    robot: Robot, balance: Balance, mode: str, duration: float, models: Sequence[str]
) -> RobotEstimate:
    columns = inertia_columns(robot, mode)
    kept = [
        place
        for place, (joint, name) in enumerate(balance.labels)
        if name != "rotor_inertia" or joint not in columns.dropped
    ]
    matrix = np.hstack([balance.matrix[:, kept], columns.columns(balance)])
    least = np.append(balance.least[kept], np.full(len(columns.names), -np.inf))
    rows = balance.rows
    wanted = rows.torque - columns.known(balance)
    stribeck = tuple(joint for joint in range(robot.n) if models[joint] != PLAIN)
    known = columns.beforehand(len(kept))
    if known.wanted.size:
        plain = solved(matrix, wanted, rows.joint, robot.n, least, known)
        _, known = certainty(matrix, wanted, rows, plain, known)
    decays = Decays(balance=balance, joints=stribeck)
    found = solved_with_decays(decays, matrix, wanted, least, known)
    asked = tuple(joint for joint in stribeck if models[joint] == AUTO)
    if asked:
        needed = with_static(found, matrix, wanted, rows, stribeck, known)
        kept_joints = tuple(joint for joint in stribeck if joint not in asked or joint in needed)
        if kept_joints != stribeck:
            start = [found.decays[stribeck.index(joint)] for joint in kept_joints]
            stribeck, decays = kept_joints, Decays(balance=balance, joints=kept_joints)
            found = solved_with_decays(decays, matrix, wanted, least, known, start)
    labels = [balance.labels[place] for place in kept]
    ranges = [decays.bounds(joint) for joint in stribeck]
    fit = Fit.of(found, labels, columns, matrix, stribeck, ranges)
    segments = time_segments(rows.start, rows.stop, rows.recording)
    jacobian = fit.jacobian[:, ~fit.at_bound]
    covariance = covariance_of(jacobian, found.solution, rows.joint, segments)
    return concluded(robot, balance, mode, fit, covariance, duration)


def _runs(recordings: object) -> list[RobotRecording]:
    given = [recordings] if isinstance(recordings, RobotRecording) else recordings
    if not isinstance(given, list | tuple) or not given:
        raise InputError(
            "a RobotRecording, or several, is expected",
            argument="recordings",
            value=recordings,
            remedy="read one with load_robot",
        )
    for run in given:
        require_kind("recordings", run, RobotRecording)
    return list(given)


def _least_speeds(
    min_speed: float | Sequence[float] | Mapping[str, float] | None, robot: Robot
) -> Array:
    if min_speed is None:
        return np.zeros(robot.n)
    if isinstance(min_speed, Mapping):
        for name in min_speed:
            if name not in robot.names:
                raise InputError("the robot has no such joint", argument="min_speed", value=name)
        given = np.array([float(min_speed.get(name, 0.0)) for name in robot.names])
    else:
        try:
            given = np.asarray(min_speed, dtype=np.float64)
        except (TypeError, ValueError):
            given = np.full((0,), np.nan)
        given = np.full(robot.n, float(given)) if given.ndim == 0 else given
    if given.shape != (robot.n,) or not np.all((given >= 0.0) & np.isfinite(given)):
        raise InputError(
            f"0 or more is expected, one for all or one for each of the {robot.n} joints",
            argument="min_speed",
            value=min_speed,
        )
    return given


def _duration(windows: float | None, motions: Sequence[Motion]) -> float:
    if windows is not None:
        number = isinstance(windows, int | float) and not isinstance(windows, bool)
        shortest = min(4.0 * float(np.median(np.diff(motion.time))) for motion in motions)
        if not number or not shortest <= windows <= 1e3:
            raise InputError(
                f"a duration in seconds of {shortest:.3g} or more is expected",
                argument="windows",
                value=windows,
            )
        return float(windows)
    return min(max(float(motion.wished.max()) for motion in motions), _LONGEST)
