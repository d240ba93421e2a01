"""A quick fit of a robot's balance, with fewer samples and the URDF's inertias."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from jointid.robot.balance.balance import Balance, balance_of
from jointid.robot.balance.inertia import InertiaColumns, basis_of, inertia_columns
from jointid.robot.balance.products import Products
from jointid.robot.balance.solving import PriorRows, solved
from jointid.robot.links.inertia_modes import URDF
from jointid.robot.links.models import PLAIN
from jointid.robot.links.robot import Robot
from jointid.robot.motion.motion import Motion

Array = NDArray[np.float64]

_SAMPLES = 2000
_WHOLE = 0.9  # smallest share of a joint's window that the other joints' windows must cover


def misfits(robot: Robot, motions: Sequence[Motion], duration: float) -> tuple[float, float]:
    """Return the relative residual of all joints' torques together, and the root mean square over the joints' own.

    The fits have the URDF's inertias and linear friction. The second value also shows faults of the wrist, because
    large torques of the shoulder do not hide them.
    """
    fit = quick_fit_of(robot, motions, duration)
    if fit is None:
        return 0.0, 0.0
    rows = fit.balance.rows
    left = np.bincount(rows.joint, fit.residual**2, robot.n)
    power = np.bincount(rows.joint, rows.torque**2, robot.n)
    known = power > 0.0
    usual = float(np.sqrt(np.mean(left[known] / power[known])))
    return float(np.sqrt(left.sum() / power.sum())), usual


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class QuickFit:
    """A fit of friction only."""

    balance: Balance
    residual: Array  # (rows,)
    held: tuple[tuple[int, str], ...]  # joint and name of friction that is held at 0

    def of_motors(self, couplings: Array) -> tuple[Array, Array]:
        """Return residuals and torques of each motor in each window, (n, windows); NaN if a window lacks a row.

        Torques at the motors do not depend on the assumed couplings. A motor's torque needs the rows of all joints that
        it turns with, in the same window. `couplings` are those of the robot of this fit.
        """
        rows, n = self.balance.rows, len(couplings)
        windows = max(summing.windows.edges.size for summing in self.balance.summings)
        key = rows.piece * windows + rows.window
        table = np.full((3, n, windows * len(self.balance.summings)), np.nan)
        table[:, rows.joint, key] = self.residual, rows.torque, rows.duration
        back = np.linalg.inv(couplings).T
        found = np.full((2, *table.shape[1:]), np.nan)
        for motor in range(n):
            joints = np.flatnonzero(np.abs(back[motor]) > 1e-12)
            used = table[2, joints]
            whole = np.all(used >= _WHOLE * used.max(axis=0), axis=0)
            for place in range(2):
                both = back[motor, joints] @ table[place, joints][:, whole]
                found[place, motor, whole] = both
        return found[0], found[1]


def quick_fit_of(
    robot: Robot, motions: Sequence[Motion], duration: float, mode: str = URDF
) -> QuickFit | None:
    """Return the fit with linear friction and the URDF's inertias, or free ones; None if nothing moves."""
    balance = balance_of(robot, motions, duration, basis_of(robot, mode))
    rows = balance.rows
    if not rows.torque.size:
        return None
    system = linear_system(balance, inertia_columns(robot, mode))
    products, table = system.products(balance), system.table
    solution = solved(products, system.least, PriorRows.nothing(products.columns))
    values = solution.values * (products.norms[-1] / products.norms[:-1])
    pairs = zip(system.kept, solution.at_bound, strict=False)
    held = [balance.labels[place] for place, at in pairs if at]
    residual = table[:, -1] - table[:, :-1] @ values
    return QuickFit(balance=balance, residual=residual, held=tuple(held))


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class LinearSystem:
    """A balance with linear friction and the inertias of a mode."""

    kept: list[int]  # friction columns of the balance
    table: Array  # (rows, columns); the target is the last one
    least: Array  # lower bounds of the parameters

    def products(self, balance: Balance) -> Products:
        """Return the products of its columns."""
        blocks = [self.table[place] for place in balance.places]
        return Products.of(blocks, list(balance.places), balance.rows)


def linear_system(balance: Balance, columns: InertiaColumns) -> LinearSystem:
    """Return the columns of linear friction and of inertias; the balance must contain them."""
    # An inseparable rotor inertia would make the columns dependent.
    kept = balance.columns_of((PLAIN,) * len(balance.places), columns.dropped)
    target = balance.rows.torque - columns.known(balance)
    return LinearSystem(
        kept=kept,
        table=np.column_stack([balance.matrix[:, kept], columns.columns(balance), target]),
        least=np.append(balance.least[kept], np.full(len(columns.names), -np.inf)),
    )


def thinned(motion: Motion) -> Motion:
    """Return a motion with every k-th sample. An interval counts as moving if all of its original intervals move."""
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
        driven=None,
        of_unit_gain=None if motion.of_unit_gain is None else motion.of_unit_gain[:, kept],
    )
