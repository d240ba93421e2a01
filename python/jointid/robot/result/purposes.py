"""Accuracy of a robot's estimate for each purpose, and possible errors of values at their bounds."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from jointid.balance.covariance import Covariance
from jointid.balance.segments import time_segments
from jointid.identification.inference.bound_intervals import held_intervals
from jointid.identification.inference.purposes import Torques, within
from jointid.robot.balance.balance import Balance
from jointid.robot.balance.fit import Fit
from jointid.robot.links.parameters import FRICTION, SHAPES
from jointid.robot.result.record import RobotEstimateRecord

Array = NDArray[np.float64]


def held_of(balance: Balance, fit: Fit) -> dict[int, tuple[float, float]]:
    """Return the interval of each coefficient held at a bound, from its own joint's torque and parameters."""
    found: dict[int, tuple[float, float]] = {}
    rows = balance.rows
    for joint in {fit.labels[place][0] for place in np.flatnonzero(fit.at_bound)} - {None}:
        own = [place for place, label in enumerate(fit.labels) if label[0] == joint]
        held = {
            number: float(fit.values[place])
            for number, place in enumerate(own)
            if fit.at_bound[place] and fit.labels[place][1] not in SHAPES
        }
        mine = rows.joint == joint
        kept = [number for number, place in enumerate(own) if not fit.at_bound[place]]
        intervals = held_intervals(
            -fit.jacobian[np.ix_(mine, own)],
            fit.residual[mine],
            kept,
            held,
            time_segments(rows.start[mine], rows.stop[mine], rows.piece[mine]),
        )
        found |= {own[number]: interval for number, interval in intervals.items()}
    return found


def torques_of(
    names: Sequence[str], balance: Balance, fit: Fit, joint: int | None = None
) -> Torques:
    """Return the size of torques in the recorded motion: of a joint or of all, in units of each residual.

    `names` are those of all parameters, as in `RobotEstimate.free`.
    """
    rows = balance.rows
    mine = np.full(rows.joint.size, True) if joint is None else rows.joint == joint
    weight = 1.0 / fit.scatter[rows.joint[mine]]
    columns = fit.jacobian[mine] * weight[:, None]
    friction = [place for place, label in enumerate(fit.labels) if label[1] in FRICTION]
    linear = [place for place in friction if fit.labels[place][1] not in SHAPES]
    return Torques(
        single={
            name: float(np.linalg.norm(columns[:, place]))
            for place, name in enumerate(names)
            if fit.labels[place][1] not in SHAPES
        },
        friction=frozenset(names[place] for place in friction),
        of_friction=float(np.linalg.norm(columns[:, linear] @ fit.values[linear])),
        of_drive=float(np.linalg.norm(rows.torque[mine] * weight)),
    )


def within_of(
    names: Sequence[str],
    balance: Balance,
    fit: Fit,
    estimate: RobotEstimateRecord,
    spread: Covariance,
) -> dict[str, float]:
    """Return by purpose the possible relative error of the quantity that it needs, for all joints together."""
    weight = 1.0 / fit.scatter[balance.rows.joint]
    columns = fit.jacobian[:, ~fit.at_bound] * weight[:, None]
    gram = columns.T @ columns
    return within(estimate.parameters, estimate.free, spread, gram, torques_of(names, balance, fit))
