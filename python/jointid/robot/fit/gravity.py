"""Direction of gravity in the base's frame, for a robot on a stand; found from the weight of the links."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from jointid.base.advice import Action
from jointid.estimate.findings import Finding, Measured
from jointid.robot.fit.attempt import Attempt
from jointid.robot.fit.excerpt_rows import ExcerptRows
from jointid.robot.fit.fact_derivatives import tilted_gravity
from jointid.robot.links.robot import Robot
from jointid.robot.result.finding_types import TYPES

Array = NDArray[np.float64]

_NORMAL = 1.96  # standard errors of a 95 % interval
_AXES = "xyz"
_SEEN = 0.1  # of gravity: a component with a larger standard error is not shown


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Gravity:
    """A direction of gravity that was found."""

    robot: Robot  # as in the attempt, with the new direction
    turn: float  # [rad], angle from the attempt's direction
    errors: Array  # (3,), errors of the components [m/s²]; infinite along axes that the motion does not show


def found_gravity(attempt: Attempt) -> Gravity:
    """Return the direction with the smallest residual of an attempt's torques; the size is known.

    Torques are linear in gravity, so one step is enough from any start.
    """
    robot, fit = attempt.robot, attempt.fit
    rows = ExcerptRows(attempt.balance, fit, attempt.excerpts, free=True)
    columns = tilted_gravity(
        robot.tree, attempt.balance, rows, attempt.excerpts, fit.inertial, np.eye(3)
    )
    share, old = rows.share(columns), robot.tree.gravity
    size = float(np.linalg.norm(old))
    pulled = old + share.values
    length = float(np.linalg.norm(pulled))
    new = pulled * (size / length) if length > 0.0 else old
    return Gravity(
        robot=replace(robot, tree=replace(robot.tree, gravity=new)),
        turn=float(np.arccos(np.clip(new @ old / size**2, -1.0, 1.0))),
        errors=share.errors,
    )


def gravity_findings(given: Robot, attempt: Attempt) -> Iterator[Finding]:
    """Yield the finding of the direction of gravity, for a robot that states none."""
    if not given.gravity_free:
        return
    pull, errors = attempt.robot.tree.gravity, found_gravity(attempt).errors
    size = float(np.linalg.norm(pull))
    seen = np.flatnonzero(errors < _SEEN * size).tolist()
    hidden = [axis for number, axis in enumerate(_AXES) if number not in seen]
    if not np.any(pull[seen]):
        yield TYPES["gravity_found"].finding(
            "this motion does not show the direction of gravity",
            Action("call", {"gravity": ...}, function="Robot.from_urdf"),
            severity="warning",
        )
        return
    # Along gravity only its size counts, and that is known.
    across = np.sqrt(np.maximum(1.0 - (pull / size) ** 2, 0.0))
    error = float(max(errors[axis] * across[axis] for axis in seen)) / size
    vector = ", ".join(f"{each:.3f}" if k in seen else "?" for k, each in enumerate(pull))
    also = f"; the motion does not show gravity along {' and '.join(hidden)}" if hidden else ""
    yield TYPES["gravity_found"].finding(
        f"gravity is ({vector}) m/s² in the base's frame, direction ± {np.degrees(_NORMAL * error):.2g}°",
        details=f"the direction is identified; the magnitude is taken from the facts{also}",
        evidence={"error": Measured(error, "rad")}
        | {_AXES[k]: Measured(float(pull[k]), "m/s²") for k in seen},
    )
