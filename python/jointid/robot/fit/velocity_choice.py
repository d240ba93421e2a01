"""Choice of each joint's velocity: derived from positions, or from the recording.

A recorded velocity may be late or filtered. A derived velocity suffers from wrong stamps and coarse positions. The
torque balance decides: it is fitted with each of them, and predicts held-out stretches of time.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from jointid.base.advice import Action
from jointid.base.errors import InputError
from jointid.estimate.findings import Finding, Measured
from jointid.estimate.wording import percent
from jointid.recording.wide.robot_recording import RobotRecording
from jointid.robot.balance.balance import Rows, balance_of
from jointid.robot.balance.choice import held_out_misfits
from jointid.robot.balance.inertia import inertia_columns
from jointid.robot.balance.products import folds_of
from jointid.robot.balance.solving import solved
from jointid.robot.fit.aligning import Alignment, aligned
from jointid.robot.fit.attempt import Attempt, Request
from jointid.robot.fit.delays import ShiftedTorque
from jointid.robot.fit.quick_fit import linear_system
from jointid.robot.links.robot import Robot
from jointid.robot.motion.motion import Motion, part_of, recorded_velocity
from jointid.robot.motion.shifts import on_the_clock_of_positions, torque_shift
from jointid.robot.result.finding_types import TYPES, listed

Array = NDArray[np.float64]

_NOISIER = 10.0  # times the noise of the derived velocity; high, because local curvature adds errors to that noise
_SURE = 3.0  # standard errors by which the prediction of held-out stretches is better
_MATTERS = 0.1  # of the squared residual: a smaller gain changes no value
_SAMPLES = 40_000  # samples of a recording that are used


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class VelocityChoice:
    """An identification with the better velocities."""

    request: Request
    alignment: Alignment
    # (n,), held-out residuals of the torque with derived and recorded velocities; None if not compared
    derived: Array | None = None
    recorded: Array | None = None


def with_better_velocities(
    recordings: Sequence[RobotRecording], robot: Robot, request: Request, shift: object
) -> VelocityChoice:
    """Return the identification on one clock, with the velocity of each joint that predicts its torque better."""
    every = tuple(range(robot.n))
    at_motor = [(robot.side or run.side) == "motor" for run in recordings]
    there = all(
        recorded_velocity(run, robot, motor) is not None
        for run, motor in zip(recordings, at_motor, strict=True)
    )
    try:
        found = aligned(recordings, robot, request, shift)
    except InputError:
        if not there:
            raise
        # noise of the derived velocities hides all motion
        request = replace(request, recorded=every)
        return VelocityChoice(request=request, alignment=aligned(recordings, robot, request, shift))
    if not there:
        return VelocityChoice(request=request, alignment=found)
    attempt = found.attempt
    derived_motions, recorded_motions, compared = _motions(recordings, attempt, found.request)
    if not compared:
        return VelocityChoice(request=request, alignment=found)
    delays = [np.zeros(robot.n)]
    stated = np.zeros(robot.n) if shift is None else torque_shift(shift, robot)
    if np.any(stated != attempt.delay):
        delays.append(stated - attempt.delay)
    left = np.array(
        [
            _misfits(attempt, request.inertia, motions, delays)
            for motions in (derived_motions, recorded_motions)
        ]
    )
    # Each velocity has its own delay: for a velocity that is as late as the torque, the delay is 0.
    totals = np.nansum(np.log(left), axis=(2, 3))
    derived, recorded = left[[0, 1], np.argmin(totals, axis=1)]
    gain = np.log(derived) - np.log(recorded)
    error = np.std(gain, axis=0, ddof=1) / np.sqrt(len(gain))
    mean = np.mean(gain, axis=0)
    better = (mean > _SURE * error) & (mean > -np.log1p(-_MATTERS))
    chosen = tuple(joint for joint in compared if better[joint])
    if chosen:
        request = replace(request, recorded=chosen)
        found = aligned(recordings, robot, request, shift)
    return VelocityChoice(
        request=request,
        alignment=found,
        derived=np.sqrt(np.mean(derived, axis=0)),
        recorded=np.sqrt(np.mean(recorded, axis=0)),
    )


def velocity_findings(choice: VelocityChoice, robot: Robot) -> Iterator[Finding]:
    """Yield the finding of joints with the recorded velocity, and the reason."""
    joints = choice.request.recorded
    if not joints:
        return
    names = [robot.names[joint] for joint in joints]
    if choice.derived is None or choice.recorded is None:
        yield TYPES["recorded_velocity"].finding(
            "the recorded velocity is used: noise hides all motion in the derived velocity",
            Action("inspect", text="the time stamps and the positions' resolution"),
            severity="warning",
        )
        return
    shares = [
        f"{name} {percent(float(choice.recorded[joint]))} instead of {percent(float(choice.derived[joint]))}"
        for name, joint in zip(names, joints, strict=True)
    ]
    yield TYPES["recorded_velocity"].finding(
        f"the recorded velocity of {listed(names)} is used: it explains the torque better than the derived velocity",
        Action("inspect", text="the time stamps and the positions' resolution"),
        details="share of held-out torque that stays unexplained, with the recorded instead of the derived velocity: "
        + ", ".join(shares),
        evidence={
            f"{name}.{source}": Measured(float(values[joint]))
            for name, joint in zip(names, joints, strict=True)
            for source, values in (("derived", choice.derived), ("recorded", choice.recorded))
        },
    )


def _motions(
    recordings: Sequence[RobotRecording], attempt: Attempt, request: Request
) -> tuple[list[Motion], list[Motion], tuple[int, ...]]:
    """Return motions with derived velocities, motions with recorded ones of some joints, and these joints.

    These joints have a recorded velocity that is not far noisier than the derived one.
    """
    robot, mask = attempt.robot, (request.slowest, request.mask_standstill)
    parts, derived = [], []
    for piece, whole in attempt.excerpts.items():
        run = recordings[attempt.runs[piece]]
        run = on_the_clock_of_positions(run, robot, attempt.delay, request.lag)
        part = part_of(run, 0, min(whole.time.size, _SAMPLES))
        parts.append(part)
        same = part.samples == whole.time.size
        derived.append(whole if same else Motion.of(part, robot, *mask))
    every = tuple(range(robot.n))
    recorded = [Motion.of(part, robot, *mask, every) for part in parts]
    noises = [
        np.mean([each.velocity_noise for each in motions], axis=0)
        for motions in (derived, recorded)
    ]
    compared = tuple(np.flatnonzero(noises[1] < _NOISIER * noises[0]).tolist())
    if compared and compared != every:
        recorded = [Motion.of(part, robot, *mask, compared) for part in parts]
    # the same rows for both
    for place, (first, other) in enumerate(zip(derived, recorded, strict=True)):
        flags = {
            name: getattr(first, name) | getattr(other, name) for name in ("moving", "motor_moving")
        }
        derived[place], recorded[place] = replace(first, **flags), replace(other, **flags)
    return derived, recorded, compared


def _misfits(attempt: Attempt, mode: str, motions: Sequence[Motion], delays: list[Array]) -> Array:
    robot = attempt.robot
    columns = inertia_columns(robot, mode)
    basis = np.column_stack([columns.given, columns.directions])
    balance = balance_of(robot, motions, attempt.duration, basis)
    shifted = ShiftedTorque(dict(enumerate(motions)), balance)
    found = []
    for delay in delays:
        rows = replace(balance.rows, torque=shifted(delay))
        system = linear_system(replace(balance, rows=rows), columns)
        products = system.products(balance)
        prior = columns.prior_rows(len(system.kept))
        scatter = solved(products, system.least, prior).scatter
        every = np.arange(products.columns)
        misfits = held_out_misfits(products.sums, prior.scaled(products.norms), scatter, every)
        left = misfits * (scatter * products.norms[-1]) ** 2
        power = _powers(rows, robot.n, len(misfits))
        there = (power > 0.0) & (left > 0.0)
        found.append(np.where(there, left / np.where(there, power, 1.0), np.nan))
    return np.array(found)


def _powers(rows: Rows, joints: int, folds: int) -> Array:
    """Return the squared torque of each stretch and joint."""
    key = folds_of(rows) * joints + rows.joint
    power = np.bincount(key, rows.torque**2, folds * joints)
    return np.asarray(power, dtype=np.float64).reshape(folds, joints)
