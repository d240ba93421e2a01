"""Friction of a robot's joints at given speeds."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.robot.links.models import terms_of
from jointid.robot.links.parameters import DIFFERENCE, MOTOR_TERMS, VISCOUS
from jointid.robot.result.record import RobotEstimateRecord, RobotJoint

Array = NDArray[np.float64]


def friction_of(estimate: RobotEstimateRecord, velocity: Array) -> Array:
    """Return the friction torque at the joints; see `RobotEstimate.friction`."""
    couplings, joints = estimate.robot.couplings, list(estimate.joints.values())
    own = [joint_friction(joint, velocity[..., k]) for k, joint in enumerate(joints)]
    total, motors = np.stack(own, axis=-1), velocity @ couplings.T
    for name, term in MOTOR_TERMS.items():
        values = np.array([_value(joint, name) for joint in joints])
        basis = _core.friction_basis(term.key, motors.ravel(), ()).reshape(motors.shape)
        total = total + (values * basis) @ couplings
        if (
            term.basis == VISCOUS.basis
        ):  # the viscous friction of a joint contains what the motors add at its speed
            total = total - (couplings**2).T @ values * velocity
    return np.asarray(total)


def joint_friction(joint: RobotJoint, velocity: Array) -> Array:
    """Return a joint's own friction at its speeds, the other joints at rest."""
    total = _value(joint, DIFFERENCE) * np.abs(velocity)
    for term in terms_of(joint.model):
        shapes = [_value(joint, name) for name in term.shapes]
        basis = _core.friction_basis(term.key, np.ravel(velocity), shapes)
        total = total + _value(joint, term.name) * basis.reshape(np.shape(velocity))
    return np.asarray(total)


def _value(joint: RobotJoint, name: str) -> float:
    found = joint.parameters.get(name)
    return 0.0 if found is None else found.value
