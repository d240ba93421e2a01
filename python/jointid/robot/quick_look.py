"""A quick look at a robot's balance: fewer samples, the URDF's inertias."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from jointid.robot.balance import balance_of
from jointid.robot.inertia import URDF, basis_of, inertia_columns
from jointid.robot.motion import Motion
from jointid.robot.products import Products, powers
from jointid.robot.robot import Robot
from jointid.robot.solving import Known, solved

Array = NDArray[np.float64]

_SAMPLES = 2000


def misfits(robot: Robot, motions: Sequence[Motion], duration: float) -> tuple[float, float]:
    """Return two relative residuals, with the URDF's inertias and linear friction.

    Returns
    -------
    whole : float
        Of all joints' torques together.
    usual : float
        Root mean square of the joints' own: what is wrong at the wrist does not drown in the shoulder's torque.
    """
    balance = balance_of(robot, motions, duration, basis_of(robot, URDF))
    rows = balance.rows
    if not rows.torque.size:
        return 0.0, 0.0
    wanted = rows.torque - inertia_columns(robot, URDF).known(balance)
    table = np.column_stack([balance.matrix, wanted])
    products = Products.of([table[place] for place in balance.places], list(balance.places), rows)
    solution = solved(products, balance.least, Known.nothing(products.columns))
    left = products.norms[-1] ** 2 * powers(products.sums.sum(axis=0), solution.values)
    power = np.bincount(rows.joint, rows.torque**2, robot.n)
    known = power > 0.0
    usual = float(np.sqrt(np.mean(left[known] / power[known])))
    return float(np.sqrt(left.sum() / power.sum())), usual


def thinned(motion: Motion) -> Motion:
    """Return a motion with every k-th sample; what is moving stays so where all intervals between are."""
    every = max(1, motion.time.size // _SAMPLES)
    kept = np.arange(0, motion.time.size, every)

    def moving(flags: NDArray[np.bool_]) -> NDArray[np.bool_]:
        return np.logical_and.reduceat(flags, kept[:-1], axis=1)[:, : kept.size - 1]

    return replace(
        motion,
        time=motion.time[kept],
        position=motion.position[:, kept],
        velocity=motion.velocity[:, kept],
        torque=motion.torque[:, kept],
        motor_position=motion.motor_position[:, kept],
        motor_velocity=motion.motor_velocity[:, kept],
        moving=moving(motion.moving),
        motor_moving=moving(motion.motor_moving),
        torque_held=motion.torque_held and every == 1,
    )
