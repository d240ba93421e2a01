"""A quick look at a robot's balance: fewer samples, the URDF's inertias."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from jointid.robot.balance import Balance, balance_of
from jointid.robot.inertia import URDF, basis_of, inertia_columns
from jointid.robot.motion import Motion
from jointid.robot.products import Products
from jointid.robot.robot import Robot
from jointid.robot.solving import Known, solved

Array = NDArray[np.float64]

_SAMPLES = 2000
_WHOLE = 0.9  # of a window of one joint, what the others' windows have to hold


def misfits(robot: Robot, motions: Sequence[Motion], duration: float) -> tuple[float, float]:
    """Return two relative residuals, with the URDF's inertias and linear friction.

    Returns
    -------
    whole : float
        Of all joints' torques together.
    usual : float
        Root mean square of the joints' own: what is wrong at the wrist does not drown in the shoulder's torque.
    """
    look = looked_at(robot, motions, duration)
    if look is None:
        return 0.0, 0.0
    rows = look.balance.rows
    left = np.bincount(rows.joint, look.residual**2, robot.n)
    power = np.bincount(rows.joint, rows.torque**2, robot.n)
    known = power > 0.0
    usual = float(np.sqrt(np.mean(left[known] / power[known])))
    return float(np.sqrt(left.sum() / power.sum())), usual


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Look:
    """The fit of friction alone.

    Attributes
    ----------
    balance : Balance
    residual : ndarray, shape (rows,)
    """

    balance: Balance
    residual: Array

    def of_motors(self, couplings: Array) -> Array:
        """Return each motor's residual over its measured torque, shape (n,); NaN where there is none.

        Torques at the motors do not depend on the couplings that are given; a motor's needs the rows of all joints with
        which it turns, in the same windows.

        Parameters
        ----------
        couplings : ndarray, shape (n, n)
            Of the robot of this look.
        """
        rows, n = self.balance.rows, len(couplings)
        windows = int(rows.window.max()) + 1
        key = rows.piece * windows + rows.window
        table = np.full((3, n, int(key.max()) + 1), np.nan)
        table[:, rows.joint, key] = self.residual, rows.torque, rows.duration
        back = np.linalg.inv(couplings).T
        found = np.full(n, np.nan)
        for motor in range(n):
            joints = np.flatnonzero(np.abs(back[motor]) > 1e-12)
            left, measured, used = table[:, joints]
            whole = np.all(used >= _WHOLE * used.max(axis=0), axis=0)
            if whole.any():
                left, measured = (back[motor, joints] @ each[:, whole] for each in (left, measured))
                found[motor] = np.linalg.norm(left) / (np.linalg.norm(measured) or 1.0)
        return found


def looked_at(robot: Robot, motions: Sequence[Motion], duration: float) -> Look | None:
    """Return the fit with the URDF's inertias and linear friction, or None where nothing moves."""
    balance = balance_of(robot, motions, duration, basis_of(robot, URDF))
    rows = balance.rows
    if not rows.torque.size:
        return None
    wanted = rows.torque - inertia_columns(robot, URDF).known(balance)
    table = np.column_stack([balance.matrix, wanted])
    products = Products.of([table[place] for place in balance.places], list(balance.places), rows)
    solution = solved(products, balance.least, Known.nothing(products.columns))
    values = solution.values * (products.norms[-1] / products.norms[:-1])
    return Look(balance=balance, residual=wanted - balance.matrix @ values)


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
