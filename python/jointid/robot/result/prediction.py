"""Prediction of a recording's torques by a robot's estimate."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from jointid.recording.wide.robot_recording import RobotRecording
from jointid.robot.balance.balance import Balance, balance_of
from jointid.robot.balance.inertia import inertia_columns
from jointid.robot.balance.loads import loaded
from jointid.robot.balance.shaped_terms import ShapedTerms
from jointid.robot.motion.motion import Motion
from jointid.robot.motion.shifts import on_the_clock_of_positions, torque_lag, torque_shift
from jointid.robot.motion.stamps import on_even_clock
from jointid.robot.result.record import RobotEstimateRecord

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True)
class RobotPrediction:
    """Accuracy of an estimate's prediction of a recording's torque.

    Attributes
    ----------
    joints : mapping of str to float
        Norm of each joint's residuals over the norm of its measured integrals.
    relative_residual : float
        The same ratio for all joints together.
    windows : int
        Number of windows.
    """

    joints: Mapping[str, float]
    relative_residual: float
    windows: int


def predict_robot(estimate: RobotEstimateRecord, recording: RobotRecording) -> RobotPrediction:
    """Predict the window integrals of a recording's torques; see `RobotEstimate.predict`."""
    robot, settings = estimate.robot, estimate.settings
    motion = motion_of(estimate, recording, mask_standstill=bool(settings["mask_standstill"]))
    basis = np.column_stack([estimate.inertial.ravel(), loading_of(estimate)])
    balance = balance_of(robot, [motion], float(settings["window_duration"]), basis)
    predicted = balance.inertia[:, 0] + balance.known + _friction(estimate, balance)
    residual, measured = balance.rows.torque - predicted, balance.rows.torque
    shares = {}
    for joint, name in enumerate(robot.names):
        mine = balance.places[joint]
        size = float(np.linalg.norm(measured[mine])) or 1.0
        shares[name] = float(np.linalg.norm(residual[mine])) / size
    return RobotPrediction(
        joints=shares,
        relative_residual=float(np.linalg.norm(residual))
        / (float(np.linalg.norm(measured)) or 1.0),
        windows=measured.size,
    )


def motion_of(
    estimate: RobotEstimateRecord, recording: RobotRecording, *, mask_standstill: bool
) -> Motion:
    """Return a recording's motion and torques with the estimate's settings: clock, delays, filters and velocities."""
    robot, settings = estimate.robot, estimate.settings
    shift, recorded = settings.get("shift", {}), settings.get("recorded_velocity", ())
    return Motion.of(
        on_the_clock_of_positions(
            on_even_clock(recording), robot, torque_shift(shift, robot), torque_lag(shift, robot)
        ),
        robot,
        np.array(settings["min_speed"]),
        mask_standstill,
        [joint for joint, name in enumerate(robot.names) if name in recorded],
    )


def loading_of(estimate: RobotEstimateRecord) -> Array:
    """Return the inertial parameters that give the load of the gears, shape (10 n,)."""
    columns, joints = inertia_columns(estimate.robot, estimate.inertia), [*estimate.joints.values()]
    values = (
        [joints[joint].parameters["inertia_scale"].value for joint in columns.joints]
        if columns.scales
        else [p.value for p in estimate.base_parameters.values()]
    )
    return columns.loading(np.array(values))


def _friction(estimate: RobotEstimateRecord, balance: Balance) -> Array:
    """Return the integrals of friction, offsets and the rotors that the links' parameters do not contain."""
    joints = list(estimate.joints.values())
    models = [joint.model for joint in joints]
    values: dict[tuple[int | None, str], float] = {
        (number, name): p.value
        for number, joint in enumerate(joints)
        for name, p in joint.parameters.items()
    }
    balance = loaded(balance, models, balance.basis[:, 1])
    total = ShapedTerms.of(balance, models).torque(values)
    for place in balance.columns_of(models):
        if balance.labels[place] in values:
            total += values[balance.labels[place]] * balance.matrix[:, place]
    return total
