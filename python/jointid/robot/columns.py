"""The linear parameters of a robot's balance, and their integrals over the windows of each joint."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from jointid.robot.integrals import Windows, direction_integrals
from jointid.robot.motion import Motion
from jointid.robot.robot import Robot

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]

MEANINGS = {
    "coulomb": "Coulomb friction",
    "static": "static friction above Coulomb friction",
    "stribeck": "decay of the static friction with the squared speed",
    "viscous": "viscous friction: torque at the joint per speed of the joint, the other joints at rest",
    "viscous_difference": "half of what viscous friction is more in the positive than in the negative direction",
    "motor_coulomb": "Coulomb friction of the motor, on its own speed",
    "motor_viscous": "viscous friction of the motor, on its own speed",
    "torque_offset": "constant torque",
    "rotor_inertia": "inertia of the motor and its gear, at the joint",
    "inertia_scale": "factor on all inertial parameters of the link that the joint moves",
}
"""Parameters of a joint, in the order of tables."""
DIFFERENCE = "viscous_difference"
"""Of joints whose friction differs between the directions; Coulomb friction's half difference is in the offset."""
_TORQUE, _DAMPING = ("N·m", "N"), ("N·m·s/rad", "N·s/m")
UNITS = {
    "coulomb": _TORQUE,
    "static": _TORQUE,
    "stribeck": ("s²/rad²", "s²/m²"),
    "viscous": _DAMPING,
    "viscous_difference": _DAMPING,
    "motor_coulomb": _TORQUE,
    "motor_viscous": _DAMPING,
    "torque_offset": _TORQUE,
    "rotor_inertia": ("kg·m²", "kg"),
    "inertia_scale": ("", ""),
}
"""Of a hinge, and of a slide."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Column:
    """One linear parameter and what it adds to each joint's balance.

    Attributes
    ----------
    joint : int
        Whose parameter it is.
    name : str
    least : float
        The lower bound: 0 of what cannot be negative.
    values : mapping of int to ndarray, shape (windows,)
        Joint whose balance it enters → its integrals over all windows.
    """

    joint: int
    name: str
    values: Mapping[int, Array]
    least: float = field(default=-np.inf)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Summing:
    """Integrals over intervals summed over the windows, of each joint's usable intervals alone.

    Attributes
    ----------
    velocity : ndarray, shape (n, samples)
        Of the joints.
    usable : ndarray of bool, shape (n, samples - 1)
        Intervals in which a joint's balance holds.
    windows : Windows
    step : ndarray, shape (samples - 1,)
        [s]
    """

    velocity: Array
    usable: Flags
    windows: Windows
    step: Array

    @classmethod
    def of(cls, robot: Robot, motion: Motion, windows: Windows) -> Summing:
        """Return it for a motion: a joint's balance holds where every friction in it is known."""
        usable = motion.moving.copy()
        for joint in range(robot.n):
            for motor in np.flatnonzero(robot.coupled & (robot.couplings[:, joint] != 0.0)):
                usable[joint] &= motion.motor_moving[motor]
        return cls(
            velocity=motion.velocity, usable=usable, windows=windows, step=np.diff(motion.time)
        )

    def __call__(self, joint: int, intervals: Array) -> Array:
        """Return the sums over the windows, of a joint's usable intervals."""
        return self.windows.summed(np.where(self.usable[joint], intervals, 0.0))


def linear_columns(robot: Robot, motion: Motion, summing: Summing) -> list[Column]:
    """Return the columns of Coulomb and viscous friction, offsets, and rotor inertias.

    A joint's viscous coefficient is the torque at the joint per its own speed. What a coupled motor adds to it is in
    it; its own coefficient says what it does beyond that: the torque at one joint per speed of another.
    """
    found: list[Column] = []
    for joint in range(robot.n):
        found += _of_joint(joint, motion, summing)
        if robot.coupled[joint]:
            found += _of_motor(joint, robot, motion, summing)
        if robot.rotor_inertias[joint] is None:
            values = rotor_values(joint, robot, motion, summing)
            found.append(Column(joint=joint, name="rotor_inertia", values=values, least=0.0))
    return found


def _of_joint(joint: int, motion: Motion, summing: Summing) -> list[Column]:
    direction = summing(joint, direction_integrals(motion.velocity[joint], summing.step))
    travel = summing(joint, np.diff(motion.position[joint]))
    distance = summing(joint, np.abs(np.diff(motion.position[joint])))
    return [
        Column(joint=joint, name="coulomb", values={joint: direction}, least=0.0),
        Column(joint=joint, name="viscous", values={joint: travel}, least=0.0),
        Column(joint=joint, name=DIFFERENCE, values={joint: distance}),
        Column(joint=joint, name="torque_offset", values={joint: summing(joint, summing.step)}),
    ]


def _of_motor(motor: int, robot: Robot, motion: Motion, summing: Summing) -> list[Column]:
    row = robot.couplings[motor]
    direction = direction_integrals(motion.motor_velocity[motor], summing.step)
    travel = np.diff(motion.motor_position[motor])
    coulomb, viscous = {}, {}
    for joint in map(int, np.flatnonzero(row)):
        share, own = row[joint], np.diff(motion.position[joint])
        coulomb[joint] = share * summing(joint, direction)
        viscous[joint] = share * summing(joint, travel - share * own)
    return [
        Column(joint=motor, name="motor_coulomb", values=coulomb, least=0.0),
        Column(joint=motor, name="motor_viscous", values=viscous, least=0.0),
    ]


def rotor_values(motor: int, robot: Robot, motion: Motion, summing: Summing) -> dict[int, Array]:
    """Integrals of the torque that a motor's inertia of 1 needs, at each joint that it turns with."""
    row, change = robot.couplings[motor], np.diff(motion.motor_velocity[motor])
    return {joint: row[joint] * summing(joint, change) for joint in map(int, np.flatnonzero(row))}
