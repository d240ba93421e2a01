"""The parts of a robot's estimate, from the solution of its balances."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from jointid.estimate.statistics import ParameterEstimate, ResidualStatistics
from jointid.estimate.student import quantile
from jointid.identification.inference.covariance import Covariance
from jointid.problem.window_table import WindowTable
from jointid.robot.balance import Balance
from jointid.robot.columns import MEANINGS
from jointid.robot.findings import findings_of
from jointid.robot.inertia import FREE, SCALED, InertiaColumns
from jointid.robot.result import RobotEstimate, RobotJoint
from jointid.robot.robot import Robot
from jointid.robot.solving import Solution

Array = NDArray[np.float64]

_UNITS = {
    "coulomb": ("N·m", "N"),
    "viscous": ("N·m·s/rad", "N·s/m"),
    "torque_offset": ("N·m", "N"),
    "rotor_inertia": ("kg·m²", "kg"),
    "motor_coulomb": ("N·m", "N"),
    "motor_viscous": ("N·m·s/rad", "N·s/m"),
}


def concluded(
    robot: Robot,
    balance: Balance,
    columns: InertiaColumns,
    mode: str,
    labels: Sequence[tuple[int, str]],
    matrix: Array,
    solution: Solution,
    covariance: Covariance,
    duration: float,
) -> RobotEstimate:
    """Return the estimate; `settings` and `seconds` are still to be set."""
    parameters = _Parameters(solution, covariance, matrix)
    of_joints: list[dict[str, ParameterEstimate]] = [{} for _ in robot.names]
    free = []
    for place, (joint, name) in enumerate(labels):
        unit = _UNITS[name][robot.tree.prismatic[joint]]
        least = 0.0 if name != "torque_offset" else -np.inf
        of_joints[joint][name] = parameters.estimate(place, name, MEANINGS[name], unit, least)
        free.append(f"{robot.names[joint]}.{name}")
    base: dict[str, ParameterEstimate] = {}
    for number, (name, unit) in enumerate(zip(columns.names, columns.units, strict=True)):
        place, joint = len(labels) + number, columns.joints[number]
        if mode == SCALED:
            shown = "inertia_scale"
            of_joints[joint][shown] = parameters.estimate(
                place, shown, MEANINGS[shown], unit, -np.inf
            )
            free.append(f"{robot.names[joint]}.{shown}")
        else:
            base[name] = parameters.estimate(place, name, "base parameter", unit, -np.inf)
            free.append(name)
    joints = {
        name: RobotJoint(
            name=name,
            parameters=of_joints[k],
            residuals=_residuals(k, balance, solution, duration),
            windows=_table(k, balance, labels, matrix, solution),
        )
        for k, name in enumerate(robot.names)
    }
    found = columns.given + columns.directions @ solution.values[len(labels) :]
    measured = float(np.linalg.norm(balance.rows.torque))
    estimate = RobotEstimate(
        joints=joints,
        inertia=mode,
        base_parameters=base,
        inertial=found.reshape(robot.n, 10),
        consistent=_consistent(mode, joints),
        relative_residual=float(np.linalg.norm(solution.residual)) / (measured or 1.0),
        free=tuple(each for each, held in zip(free, solution.at_bound, strict=True) if not held),
        covariance=covariance.matrix,
        condition=covariance.condition,
        findings=(),
        robot=robot,
        settings={},
    )
    return findings_of(estimate, columns)


class _Parameters:
    """Values and their errors, by the place of their columns."""

    def __init__(self, solution: Solution, covariance: Covariance, matrix: Array) -> None:
        self._solution, self._covariance = solution, covariance
        self._places = np.cumsum(~solution.at_bound) - 1
        self._present = np.linalg.norm(matrix, axis=0) > 0.0

    def estimate(
        self, place: int, name: str, meaning: str, unit: str, least: float
    ) -> ParameterEstimate:
        held = bool(self._solution.at_bound[place])
        stderr, interval = None, None
        value = float(self._solution.values[place])
        if not held:
            number = int(self._places[place])
            stderr = float(self._covariance.stderr[number])
            stderr = stderr if self._present[place] else float("inf")
            half = quantile(0.975, float(self._covariance.freedom[number])) * stderr
            interval = (value - half, value + half)
        return ParameterEstimate(
            name=name,
            meaning=meaning,
            unit=unit,
            value=value,
            stderr=stderr,
            interval=interval,
            min=least,
            max=float("inf"),
            vary=True,
            at_bound="min" if held else None,
            shift_halved=None,
            shift_doubled=None,
        )


def _residuals(
    joint: int, balance: Balance, solution: Solution, duration: float
) -> ResidualStatistics:
    mine = balance.rows.joint == joint
    residual, measured = solution.residual[mine], balance.rows.torque[mine]
    used, velocity = balance.rows.duration[mine], balance.rows.velocity[mine]
    power = float(residual @ residual)
    centred = measured - measured.mean() if measured.size else measured
    change = float(np.mean(np.diff(velocity) ** 2)) if velocity.size > 1 else 0.0
    return ResidualStatistics(
        windows=int(mine.sum()),
        window_duration=duration,
        noise_share=2.0 * float(balance.velocity_noise[joint]) ** 2 / (change or np.inf),
        rms=float(np.sqrt(np.mean((residual / used) ** 2))) if used.size else 0.0,
        relative=np.sqrt(power) / (float(np.linalg.norm(measured)) or 1.0),
        r_squared=1.0 - power / (float(centred @ centred) or 1.0),
        autocorrelation=float(residual[1:] @ residual[:-1]) / (power or 1.0),
        samples=balance.samples,
        left_out=float(balance.standing[joint]),
        standing=float(balance.standing[joint]),
    )


def _table(
    joint: int,
    balance: Balance,
    labels: Sequence[tuple[int, str]],
    matrix: Array,
    solution: Solution,
) -> WindowTable:
    mine = balance.rows.joint == joint
    friction = [
        place
        for place, (owner, name) in enumerate(labels)
        if owner == joint and name in ("coulomb", "viscous")
    ]
    own = matrix[np.ix_(mine, friction)] @ solution.values[friction]
    residual = solution.residual[mine]
    rows = balance.rows
    return WindowTable(
        recording=rows.recording[mine],
        start=rows.start[mine],
        stop=rows.stop[mine],
        duration=rows.duration[mine],
        measured=rows.torque[mine],
        fitted=rows.torque[mine] - residual,
        velocity=rows.velocity[mine],
        friction=(own + residual) / rows.duration[mine],
    )


def _consistent(mode: str, joints: dict[str, RobotJoint]) -> bool | None:
    """Whether a body can have the inertial parameters: the URDF's are not judged, scales must be positive."""
    if mode == FREE:
        return None
    scales = [each.parameters.get("inertia_scale") for each in joints.values()]
    return all(each is None or each.value > 0.0 for each in scales)
