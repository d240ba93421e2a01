"""The friction of a robot's joints at given speeds."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from jointid.robot.columns import DIFFERENCE
from jointid.robot.result import RobotEstimate

Array = NDArray[np.float64]


def friction_of(estimate: RobotEstimate, velocity: Array) -> Array:
    """Return the friction torque at the joints; see `RobotEstimate.friction`."""
    robot = estimate.robot
    coulomb, static, stribeck, viscous, motor_coulomb, motor_viscous = (
        _values(estimate, name)
        for name in ("coulomb", "static", "stribeck", "viscous", "motor_coulomb", "motor_viscous")
    )
    dry = coulomb + static * np.exp(-stribeck * velocity**2)
    motors = velocity @ robot.couplings.T
    # A joint's viscous coefficient contains what the motors add at its own speed.
    own = viscous - (robot.couplings**2).T @ motor_viscous
    of_motors = motor_coulomb * np.sign(motors) + motor_viscous * motors
    difference = _values(estimate, DIFFERENCE) * np.abs(velocity)
    return np.asarray(
        dry * np.sign(velocity) + own * velocity + difference + of_motors @ robot.couplings
    )


def _values(estimate: RobotEstimate, name: str) -> Array:
    found = [joint.parameters.get(name) for joint in estimate.joints.values()]
    return np.array([0.0 if each is None else each.value for each in found])
