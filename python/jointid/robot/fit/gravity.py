"""Where gravity pulls on a robot on a stand: its direction in the base's frame, from what the links weigh."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from jointid.estimate.findings import Finding, Measured
from jointid.robot.fit.attempt import Attempt
from jointid.robot.fit.excerpt_rows import ExcerptRows
from jointid.robot.fit.perturbed import tilted_gravity
from jointid.robot.links.robot import Robot
from jointid.robot.result.finding_types import TYPES

Array = NDArray[np.float64]

_NORMAL = 1.96  # standard errors of a 95 % interval


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Gravity:
    """A direction that was found."""

    robot: Robot  # as in the attempt, with it
    turn: float  # [rad], from the attempt's direction
    error: (
        float  # [rad], standard error of the direction; infinite where the motion does not tell it
    )


def found_gravity(attempt: Attempt) -> Gravity:
    """Return the direction that leaves least of an attempt's torques; its size is given.

    Torques are linear in gravity, so that one step leads there from any direction.
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
    if not length > 0.0:
        return Gravity(robot=robot, turn=0.0, error=np.inf)
    new = pulled * (size / length)
    turn = float(np.arccos(np.clip(new @ old / size**2, -1.0, 1.0)))
    across = np.sqrt(np.maximum(1.0 - (new / size) ** 2, 0.0))
    return Gravity(
        robot=replace(robot, tree=replace(robot.tree, gravity=new)),
        turn=turn,
        error=float(np.max(np.where(across > 1e-6, share.errors * across, 0.0))) / size,
    )


def gravity_findings(given: Robot, attempt: Attempt) -> Iterator[Finding]:
    """The direction of gravity that was found for a robot that states none."""
    if not given.gravity_free:
        return
    pull, error = attempt.robot.tree.gravity, found_gravity(attempt).error
    vector = ", ".join(f"{each:.3f}" for each in pull)
    degrees = np.degrees(_NORMAL * error)
    yield TYPES["gravity_found"].finding(
        f"gravity is ({vector}) m/s² in the base's frame, to ± {degrees:.2g}°",
        details="its direction was identified, and its size is given",
        evidence={"error": Measured(error, "rad")}
        | {axis: Measured(float(each), "m/s²") for axis, each in zip("xyz", pull, strict=True)},
    )
