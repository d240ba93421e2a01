"""Zero of the recording's positions: the URDF's zero, or a quarter or half turn from it.

A controller and a URDF often define zero at different poses. Then the gravity torque and the links' inertia are wrong
in every pose. With the URDF's inertias the balance has a large residual, also with friction of any size. Other zeros
are tried joint by joint.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from jointid.robot.fit.quick_fit import misfits, thinned
from jointid.robot.links.robot import Robot
from jointid.robot.motion.motion import Motion

Array = NDArray[np.float64]

_POOR = 0.12  # of the torque: a smaller residual is not examined
_TURNS = (0.5 * np.pi, -0.5 * np.pi, np.pi)
_BETTER = 0.7  # of the smallest residual so far: required of one more turned joint
_CLEARLY = 0.5  # of the residual without offsets: required of all offsets together; also a residual below `_POOR`


@dataclass(frozen=True, slots=True, kw_only=True)
class Zeros:
    """Result of the search for zero offsets."""

    offsets: tuple[float, ...]  # [rad]; all 0 if no others fit clearly better
    before: float  # relative residual of all joints with the URDF's inertias, without the offsets
    after: float  # the same with the offsets

    @property
    def found(self) -> bool:
        """Whether any offset is not 0."""
        return any(each != 0.0 for each in self.offsets)


def zeros_of(robot: Robot, motions: Sequence[Motion], duration: float) -> Zeros:
    """Return the multiples of a quarter turn with which the URDF's inertias fit."""
    thin = [thinned(motion) for motion in motions]
    turned = np.zeros(robot.n)
    best = before = _misfit(robot, thin, turned, duration)
    hinges = [joint for joint in range(robot.n) if not robot.tree.prismatic[joint]]
    while best > _POOR:
        found = [
            (_misfit(robot, thin, trial, duration), tuple(trial))
            for joint in hinges
            if turned[joint] == 0.0
            for trial in (turned + angle * np.eye(robot.n)[joint] for angle in _TURNS)
        ]
        if not found or min(found)[0] > _BETTER * best:
            break
        best, offsets = min(found)
        turned = np.array(offsets)
    if best > min(_CLEARLY * before, _POOR):
        turned = np.zeros(robot.n)
    return Zeros(offsets=tuple(float(each) for each in turned), before=before, after=best)


def _misfit(robot: Robot, motions: Sequence[Motion], offsets: Array, duration: float) -> float:
    moved = [replace(each, position=each.position + offsets[:, None]) for each in motions]
    return misfits(robot, moved, duration)[0]
