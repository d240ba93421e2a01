"""Factor of each joint's torque on the torque of the URDF's links, with friction fitted."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from jointid.problem.unsigned_torque import CLEAR, without
from jointid.robot.balance.inertia import InertiaColumns
from jointid.robot.checks.filtered_regression import SETTINGS
from jointid.robot.checks.plain_regression import Block, Columns
from jointid.robot.links.models import PLAIN
from jointid.robot.links.robot import Robot
from jointid.robot.motion.plain_motion import PlainSignals

Array = NDArray[np.float64]

_SEEN = 0.15  # of the squared residual with friction alone: largest residual with the links for a valid factor

_WORSE = 1.2  # of the squared residual with friction alone: with a larger residual, the factor is not this joint's


@dataclass(frozen=True, slots=True, kw_only=True)
class LinkFactor:
    """Factor of one joint's torque on the URDF's, and its squared residuals over its torque."""

    value: float
    left: float  # residual with the factor
    without: float  # residual without the links
    given: float  # residual with a factor of 1

    @property
    def sure(self) -> bool:
        """Whether the links explain enough for a valid factor."""
        return self.left < _SEEN * self.without and self.left < CLEAR**2

    def contradicts(self, factor: float) -> bool:
        """Return whether the residual is larger with a factor than without the links."""
        curvature = (self.without - self.left) / self.value**2 if self.value else 0.0
        return self.left + (factor - self.value) ** 2 * curvature > _WORSE * self.without


def link_rows(
    signals: Sequence[PlainSignals], robot: Robot, directions: Array | None = None
) -> dict[int, Block]:
    """Return rows with the links' torque as the last column, or with further changes of their parameters after it."""
    weights = robot.tree.inertias.reshape(-1, 1)
    every = weights if directions is None else np.hstack([weights, directions])
    count = every.shape[1]
    links = InertiaColumns(
        names=tuple(f"links {number}" for number in range(count)),
        units=("",) * count,
        joints=(0,) * count,
        directions=every,
        given=np.zeros(weights.size),
        start=np.ones(count),
    )
    other = replace(robot, rotor_inertias=(None,) * robot.n)
    columns = Columns(other, links, np.zeros(robot.n), (PLAIN,) * robot.n, links.given)
    return columns.blocks(signals, *SETTINGS[0], np.zeros((robot.n, 1)))


def link_factor(block: Block) -> LinkFactor:
    """Return the factor from the rows of a joint."""
    target, links = block.targets[:, 0], block.matrix[:, -1]
    power = float(target @ target) or 1.0
    rest = without(block.matrix[:, :-1], np.column_stack([target, links]))
    length = float(rest[:, 1] @ rest[:, 1])
    seen = length > 1e-12 * max(float(links @ links), 1e-300)
    value = float(rest[:, 0] @ rest[:, 1]) / length if seen else 0.0

    def left(factor: float) -> float:
        return float(np.sum((rest[:, 0] - factor * rest[:, 1]) ** 2)) / power

    return LinkFactor(value=value, left=left(value), without=left(0.0), given=left(1.0))


def weight_factors(signals: Sequence[PlainSignals], robot: Robot) -> dict[int, float]:
    """Return the factor of each joint's torque on the torque of the URDF's links, if the links explain that torque."""
    factors = {joint: link_factor(block) for joint, block in link_rows(signals, robot).items()}
    return {joint: each.value for joint, each in factors.items() if each.sure}
