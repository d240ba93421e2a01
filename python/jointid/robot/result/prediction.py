"""What a robot's estimate says of a recording that it need not have seen."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from jointid.recording.wide.robot_recording import RobotRecording
from jointid.robot.balance.balance import Balance, balance_of
from jointid.robot.balance.shaped_terms import ShapedTerms
from jointid.robot.motion.motion import Motion
from jointid.robot.motion.shifts import torque_shift, without_delay
from jointid.robot.motion.stamps import on_even_clock
from jointid.robot.result.record import RobotEstimateRecord

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True)
class RobotPrediction:
    """How well an estimate predicts the torque of a recording.

    Attributes
    ----------
    joints : mapping of str to float
        Norm of each joint's residuals over the norm of its measured integrals.
    relative_residual : float
        The same of all joints together.
    windows : int
    """

    joints: Mapping[str, float]
    relative_residual: float
    windows: int


def predict_robot(estimate: RobotEstimateRecord, recording: RobotRecording) -> RobotPrediction:
    """Predict the window integrals of a recording's torques; see `RobotEstimate.predict`."""
    robot, settings = estimate.robot, estimate.settings
    motion = Motion.of(
        without_delay(
            on_even_clock(recording), robot, torque_shift(settings.get("shift", {}), robot)
        ),
        robot,
        np.array(settings["min_speed"]),
        bool(settings["mask_standstill"]),
        [
            joint
            for joint, name in enumerate(robot.names)
            if name in settings.get("recorded_velocity", ())
        ],
    )
    whole = estimate.inertial.reshape(-1, 1)
    balance = balance_of(robot, [motion], float(settings["window_duration"]), whole)
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


def _friction(estimate: RobotEstimateRecord, balance: Balance) -> Array:
    """Integrals of friction, offsets and the rotors that the links' parameters do not contain."""
    joints = list(estimate.joints.values())
    models = [joint.model for joint in joints]
    values: dict[tuple[int | None, str], float] = {
        (number, name): p.value
        for number, joint in enumerate(joints)
        for name, p in joint.parameters.items()
    }
    total = ShapedTerms.of(balance, models).torque(values)
    for place in balance.columns_of(models):
        if balance.labels[place] in values:
            total += values[balance.labels[place]] * balance.matrix[:, place]
    return total
