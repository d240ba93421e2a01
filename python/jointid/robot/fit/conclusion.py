"""The parts of a robot's estimate, from the solution of its balances."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from jointid.balance.covariance import Covariance
from jointid.estimate.statistics import ParameterEstimate, ResidualStatistics
from jointid.estimate.student import quantile
from jointid.problem.window_table import WindowTable
from jointid.robot.balance.balance import Balance
from jointid.robot.balance.fit import Fit
from jointid.robot.links.bodies import possible
from jointid.robot.links.inertia_modes import SCALED
from jointid.robot.links.models import LOAD, terms_of
from jointid.robot.links.parameters import DIFFERENCE, parameter_facts
from jointid.robot.links.robot import Robot
from jointid.robot.result.findings import findings_of
from jointid.robot.result.purposes import held_of, torques_of, within_of
from jointid.robot.result.record import RobotJoint
from jointid.robot.result.result import RobotEstimate

Array = NDArray[np.float64]


def concluded(
    robot: Robot,
    balance: Balance,
    mode: str,
    fit: Fit,
    covariance: Covariance,
    duration: float,
    runs: Sequence[int],
) -> RobotEstimate:
    """Return the estimate; `settings` and `seconds` are still to be set. `runs`: the recording of each piece."""
    places = np.cumsum(~fit.at_bound) - 1
    of_joints: list[dict[str, ParameterEstimate]] = [{} for _ in robot.names]
    base: dict[str, ParameterEstimate] = {}
    free: list[str] = []
    held = held_of(balance, fit)
    facts = [parameter_facts(model) for model in fit.models]
    names = [
        name if joint is None else f"{robot.names[joint]}.{name}" for joint, name in fit.labels
    ]
    for number, (joint, name) in enumerate(fit.labels):
        place = None if fit.at_bound[number] else int(places[number])
        if joint is None:
            p = _parameter(
                name, "base parameter", fit.units[number], fit, number, place, covariance
            )
            base[name] = p
        else:
            meaning, *units = facts[joint][name]
            unit = units[robot.tree.prismatic[joint]]
            p = _parameter(name, meaning, unit, fit, number, place, covariance)
            if number in held:
                p = replace(p, interval=held[number])
            of_joints[joint][name] = p
        if place is not None:
            free.append(names[number])
    joints = {
        name: RobotJoint(
            name=name,
            model=fit.models[k],
            parameters={key: of_joints[k][key] for key in facts[k] if key in of_joints[k]},
            residuals=_residuals(k, balance, fit, duration),
            windows=_table(k, balance, fit, runs),
        )
        for k, name in enumerate(robot.names)
    }
    measured = float(np.linalg.norm(balance.rows.torque))
    estimate = RobotEstimate(
        joints=joints,
        inertia=mode,
        base_parameters=base,
        inertial=fit.inertial.reshape(robot.n, 10),
        consistent=possible(fit.inertial.reshape(robot.n, 10)) if mode == SCALED else None,
        relative_residual=float(np.linalg.norm(fit.residual)) / (measured or 1.0),
        free=tuple(free),
        covariance=covariance.matrix,
        condition=covariance.condition,
        findings=(),
        robot=robot,
        settings={},
    )
    torques = {
        name: torques_of([n.removeprefix(f"{name}.") for n in names], balance, fit, k)
        for k, name in enumerate(robot.names)
    }
    return replace(
        estimate,
        within=within_of(names, balance, fit, estimate, covariance),
        findings=findings_of(estimate, fit.columns, torques),
    )


def _parameter(
    name: str,
    meaning: str,
    unit: str,
    fit: Fit,
    number: int,
    place: int | None,
    covariance: Covariance,
) -> ParameterEstimate:
    value = float(fit.values[number])
    stderr, interval = None, None
    if place is not None:
        present = bool(np.any(fit.jacobian[:, number]))
        stderr = float(covariance.stderr[place]) if present else float("inf")
        half = quantile(0.975, float(covariance.freedom[place])) * stderr
        interval = (value - half, value + half)
    low, high = fit.bounds[number]
    return ParameterEstimate(
        name=name,
        meaning=meaning,
        unit=unit,
        value=value,
        stderr=stderr,
        interval=interval,
        min=low,
        max=high,
        vary=True,
        at_bound=None if place is not None else "max" if value >= high else "min",
        shift_halved=None,
        shift_doubled=None,
    )


def _residuals(joint: int, balance: Balance, fit: Fit, duration: float) -> ResidualStatistics:
    mine = balance.rows.joint == joint
    residual, measured = fit.residual[mine], balance.rows.torque[mine]
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


def _table(joint: int, balance: Balance, fit: Fit, runs: Sequence[int]) -> WindowTable:
    mine = balance.rows.joint == joint
    names = {DIFFERENCE, *(term.name for term in terms_of(fit.models[joint]))} - {LOAD.name}
    friction = [
        place for place, label in enumerate(fit.labels) if label[0] == joint and label[1] in names
    ]
    own = fit.jacobian[np.ix_(mine, friction)] @ fit.values[friction]
    residual = fit.residual[mine]
    rows = balance.rows
    return WindowTable(
        recording=np.array(runs)[rows.piece[mine]],
        start=rows.start[mine],
        stop=rows.stop[mine],
        duration=rows.duration[mine],
        measured=rows.torque[mine],
        fitted=rows.torque[mine] - residual,
        velocity=rows.velocity[mine],
        friction=(own + residual) / rows.duration[mine],
    )
