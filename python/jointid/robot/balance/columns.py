"""The linear parameters of a robot's balance, and their integrals over the windows of each joint."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.balance.windows import Windows, direction_integrals, interval_means, torque_integrals
from jointid.robot.links.models import LOAD
from jointid.robot.links.parameters import (
    CONSTANT,
    DIFFERENCE,
    LINEAR_TERMS,
    MOTOR_TERMS,
    POSITION_GAIN,
    VISCOUS,
    least_of,
)
from jointid.robot.links.robot import Robot
from jointid.robot.motion.motion import Motion

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Column:
    """One linear parameter and its columns in the balances of the joints."""

    joint: int  # joint that the parameter belongs to
    name: str
    values: Mapping[int, Array]  # joint of the balance → integrals over all windows
    key: str = ""  # key of the term in the core's table; empty for parameters that every joint has
    least: float = field(default=-np.inf)  # lower bound: 0 if the parameter cannot be negative


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Summing:
    """Sums of integrals over the windows, from the usable intervals of each joint."""

    velocity: Array  # (n, samples), velocities of the joints
    usable: Flags  # (n, samples - 1), intervals in which the joint's balance holds
    windows: Windows
    step: Array  # (samples - 1,) [s]

    @classmethod
    def of(cls, robot: Robot, motion: Motion, windows: Windows) -> Summing:
        """Return the sums for a motion. A joint's balance holds in an interval if every friction in it is known."""
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
    """Return the columns of friction without shape parameters, of offsets, and of rotor inertias.

    A joint's viscous coefficient is the torque at the joint per its own speed. It contains the contribution of a
    coupled motor. The motor's own coefficient describes the coupling: the torque at one joint per speed of another
    joint.
    """
    found: list[Column] = []
    for joint in range(robot.n):
        found += _of_joint(joint, motion, summing)
        if robot.coupled[joint]:
            found += _of_motor(joint, robot, motion, summing)
        if robot.rotor_inertias[joint] is None:
            values = rotor_values(joint, robot, motion, summing)
            found.append(Column(joint=joint, name="rotor_inertia", values=values, least=0.0))
        if _gainless(motion, joint):
            assert motion.of_unit_gain is not None
            # The drive's torque is subtracted from the torque that the other parameters explain.
            pushed = torque_integrals(motion.of_unit_gain[joint], summing.step, motion.torque_held)
            values = {joint: summing(joint, -pushed)}
            found.append(Column(joint=joint, name=POSITION_GAIN, values=values, least=0.0))
    return found


def _gainless(motion: Motion, joint: int) -> bool:
    """Return whether the gain of the joint's drive is identified."""
    return motion.of_unit_gain is not None and bool(motion.of_unit_gain[joint].any())


def _of_joint(joint: int, motion: Motion, summing: Summing) -> list[Column]:
    velocity, travel = motion.velocity[joint], np.diff(motion.position[joint])

    def column(name: str, intervals: Array, key: str = "", least: float = -np.inf) -> Column:
        values = {joint: summing(joint, intervals)}
        return Column(joint=joint, name=name, key=key, values=values, least=least)

    return [
        *(
            column(t.name, _integrals(t, velocity, travel, summing.step), key, least_of(t))
            for key, t in LINEAR_TERMS.items()
        ),
        # The load is known only when the links' inertias are known: see `loads`.
        column(LOAD.name, np.zeros_like(travel), LOAD.key, least_of(LOAD)),
        column(DIFFERENCE, np.abs(travel)),
        # A gain is identified from the weight at rest. An offset would absorb that weight.
        *((column("torque_offset", summing.step),) if not _gainless(motion, joint) else ()),
    ]


def _of_motor(motor: int, robot: Robot, motion: Motion, summing: Summing) -> list[Column]:
    row, travel = robot.couplings[motor], np.diff(motion.motor_position[motor])
    found = []
    for name, term in MOTOR_TERMS.items():
        whole = _integrals(term, motion.motor_velocity[motor], travel, summing.step)
        values = {}
        for joint in map(int, np.flatnonzero(row)):
            own = row[joint] * np.diff(motion.position[joint])
            beyond = whole - own if term.basis == VISCOUS.basis else whole
            values[joint] = row[joint] * summing(joint, beyond)
        found.append(Column(joint=motor, name=name, values=values, least=least_of(term)))
    return found


def _integrals(term: _core.Term, velocity: Array, travel: Array, step: Array) -> Array:
    """Return the integrals of a term's basis over the intervals."""
    if term.basis == CONSTANT.basis:
        return direction_integrals(velocity, step)
    if term.basis == VISCOUS.basis:
        return travel
    return interval_means(_core.friction_basis(term.key, velocity, ()), velocity) * step


def rotor_values(motor: int, robot: Robot, motion: Motion, summing: Summing) -> dict[int, Array]:
    """Return the integrals of the torque for a motor inertia of 1, at each joint that the motor turns."""
    row, change = robot.couplings[motor], np.diff(motion.motor_velocity[motor])
    return {joint: row[joint] * summing(joint, change) for joint in map(int, np.flatnonzero(row))}
