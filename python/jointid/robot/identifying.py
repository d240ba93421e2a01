"""`identify_robot`: the friction of all joints at once, with the inertia of all links."""

from __future__ import annotations

import itertools
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
from jointid.robot.asked import duration_of, least_speeds, recordings_of
from jointid.robot.balance import Balance, balance_of
from jointid.robot.choice import certainty, with_static
from jointid.robot.conclusion import concluded
from jointid.robot.decays import Decays, solved_with_decays
from jointid.robot.findings import doubtful_joints, named_fact, turned_zeros, wrong_inertias
from jointid.robot.fit import Fit
from jointid.robot.inertia import MODES, SCALED, URDF, basis_of, inertia_columns
from jointid.robot.models import AUTO, PLAIN, friction_models
from jointid.robot.motion import Motion, part_of
from jointid.robot.products import Products
from jointid.robot.resampling import RobotDraws
from jointid.robot.result import RobotEstimate
from jointid.robot.robot import Robot
from jointid.robot.solving import solved
from jointid.robot.stamps import all_on_even_clocks
from jointid.robot.wrong_facts import wrong_fact
from jointid.robot.zeros import zeros_of

Array = NDArray[np.float64]

_PIECE = 120_000  # samples of a long recording that are looked at at once
_LOOKS = 4  # recordings by whose beginnings facts are judged


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
    windows : float or int, optional
        Duration of the windows [s]; a whole number is how many. Default: what the velocities' noise asks for, at most
        0.1 s; of recordings longer than some minutes towards 0.1 s, because there are enough of them.
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
    runs = all_on_even_clocks(recordings_of(recordings))
    if inertia not in MODES:
        raise InputError(
            f"one of {', '.join(MODES)} is expected", argument="inertia", value=inertia
        )
    models = friction_models(model, robot)
    slowest = least_speeds(min_speed, robot)
    pieces = _pieces(runs)
    numbers = [number for number, _, _ in pieces]
    firsts = [pieces[numbers.index(number)] for number in range(len(runs))][:_LOOKS]

    def motion(piece: tuple[int, int, int]) -> Motion:
        number, low, high = piece
        return Motion.of(part_of(runs[number], low, high), robot, slowest, mask_standstill)

    looks = {piece: motion(piece) for piece in firsts}
    duration = duration_of(windows, list(looks.values()), sum(run.duration for run in runs))
    zeros = None
    if robot.zero_offsets is None:
        zeros = zeros_of(robot, list(looks.values()), duration)
        if zeros.found:
            robot = replace(robot, zero_offsets=zeros.offsets)
            looks = {piece: motion(piece) for piece in firsts}
    every = (looks[piece] if piece in looks else motion(piece) for piece in pieces)
    balance = balance_of(robot, every, duration, basis_of(robot, inertia))
    if not balance.rows.torque.size:
        raise InputError("no joint moves", argument="recordings", value=runs[0].name)
    estimate = _solved(robot, balance, inertia, duration, models, numbers)
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
        scaled = _solved(robot, balance, SCALED, duration, models, numbers)
        findings = (*wrong_inertias(estimate, scaled), *findings)
    suspects = doubtful_joints(estimate)
    wrong = wrong_fact(robot, list(looks.values()), duration, suspects) if suspects else None
    if wrong is not None:
        findings = (named_fact(wrong), *findings)
    return replace(
        estimate,
        findings=findings,
        settings=settings,
        seconds=time.perf_counter() - started,
    )


def _solved(
    robot: Robot,
    balance: Balance,
    mode: str,
    duration: float,
    models: Sequence[str],
    runs: Sequence[int],
) -> RobotEstimate:
    columns = inertia_columns(robot, mode)
    kept = [
        place
        for place, (joint, name) in enumerate(balance.labels)
        if name != "rotor_inertia" or joint not in columns.dropped
    ]
    wanted = balance.rows.torque - columns.known(balance)
    inertial = columns.columns(balance)
    blocks = [
        np.column_stack(
            [
                balance.matrix[place][:, kept],
                inertial[place],
                wanted[place],
            ]
        )
        for place in balance.places
    ]
    products = Products.of(blocks, list(balance.places), balance.rows)
    least = np.append(balance.least[kept], np.full(len(columns.names), -np.inf))
    known = columns.beforehand(len(kept))
    if known.wanted.size:
        _, known = certainty(products, solved(products, least, known), known)
    stribeck = tuple(joint for joint in range(robot.n) if models[joint] != PLAIN)
    decays = Decays(balance=balance, joints=stribeck)
    found = solved_with_decays(decays, products, least, known)
    if AUTO in models:
        needed = with_static(found, products, decays.norms, stribeck, known)
        left = tuple(joint for joint in stribeck if models[joint] != AUTO or joint in needed)
        if left != stribeck:
            start = [float(found.logs[stribeck.index(joint)]) for joint in left]
            decays = Decays(balance=balance, joints=left)
            found = solved_with_decays(decays, products, least, known, start)
    fit = Fit.of(balance, columns, kept, products, decays, found)
    estimate = concluded(robot, balance, mode, fit, fit.covariance(balance), duration, runs)
    return replace(estimate, draws=RobotDraws.of(balance, fit, known))


def _pieces(runs: Sequence[RobotRecording]) -> list[tuple[int, int, int]]:
    """Parts of the recordings that are looked at at once: number of the recording, first sample, end."""
    found = []
    for number, run in enumerate(runs):
        count = max(1, -(-run.samples // _PIECE))
        edges = np.linspace(0, run.samples, count + 1).round().astype(int).tolist()
        found += [(number, low, high) for low, high in itertools.pairwise(edges)]
    return found
