"""Prediction of a `RobotEstimate` for any motion, integrated over windows, with pinocchio's regressors.

Over a window, the integral of torque is the change of momentum minus the integral of Cᵀ v - g, plus friction's.
"""

from __future__ import annotations

from typing import Any

import numpy as np

import jointid as jid
from arms.classical import Array
from arms.held_out import Windows

_NEAR = 1e-4  # of a velocity, for the change of the inertia along it [s]


def momentum_and_force(
    model: Any, inertial: Array, position: Array, velocity: Array
) -> tuple[Array, Array]:
    """Return M v and g - Cᵀ v of links with these inertial parameters (ten per link, as in pinocchio)."""
    import pinocchio

    state, rest = model.createData(), np.zeros(model.nv)

    def torque(q: Array, v: Array, a: Array) -> Array:
        regressor = pinocchio.computeJointTorqueRegressor(model, state, q, v, a)
        return np.asarray(regressor @ inertial)

    momentum, force = np.empty_like(velocity), np.empty_like(velocity)
    for i, (q, v) in enumerate(zip(position, velocity, strict=True)):
        gravity = torque(q, rest, rest)
        momentum[i] = torque(q, rest, v) - gravity
        ahead, behind = q + _NEAR * v, q - _NEAR * v
        change = torque(ahead, rest, v) - torque(ahead, rest, rest)
        change -= torque(behind, rest, v) - torque(behind, rest, rest)
        # d/dt M = C + Cᵀ
        transposed = change / (2.0 * _NEAR) - (torque(q, v, rest) - gravity)
        force[i] = gravity - transposed
    return momentum, force


def predicted(
    found: jid.RobotEstimate,
    model: Any,
    time: Array,
    position: Array,
    velocity: Array,
    windows: Windows,
) -> Array:
    """Return integrals of the predicted torque at the joints, (windows, joints)."""
    momentum, force = momentum_and_force(model, found.inertial.ravel(), position, velocity)
    joints = list(found.joints.values())
    turns = found.robot.couplings
    rotors = [_value(joint, "rotor_inertia") for joint in joints]
    for motor, given in enumerate(found.robot.rotor_inertias):
        rotor = rotors[motor] if given is None else given
        momentum += rotor * np.outer(velocity @ turns[motor], turns[motor])
    offset = np.array([_value(joint, "torque_offset") for joint in joints])
    force += found.friction(velocity) + offset
    change = momentum[windows.last] - momentum[windows.first]
    return np.asarray(change + windows.integrals(time, force))


def _value(joint: Any, name: str) -> float:
    parameter = joint.parameters.get(name)
    return 0.0 if parameter is None else float(parameter.value)
