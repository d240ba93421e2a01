"""A weak prior of base parameters from the URDF, and the inertial parameters closest to the URDF's.

A short motion leaves some base parameters nearly free. Plain least squares fits noise with them, and predicts other
motions worse. In the prior, each value of the URDF has the uncertainty that a link of its mass and size can have. It
holds the parameters where the data give no information, and hardly moves those that the data determine.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Self

import numpy as np
from numpy.typing import NDArray

from jointid.robot.links.robot import Robot

Array = NDArray[np.float64]

_LIGHTEST = 0.1  # of the links' mean mass: a lighter link is as uncertain as a link with this mass
_SHORTEST = 0.05  # [m]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Prior:
    """A normal distribution of the base parameters."""

    mean: Array  # (base,)
    root: Array  # (base, base), takes differences from the mean to unit variance
    urdf: Array  # (10 n,), inertial parameters of the URDF
    # (10 n, base), smallest change of the inertial parameters per change of the base parameters, relative to the
    # parameters' sizes
    gain: Array
    of_links: Array  # (base, 10 n), base parameters per inertial parameter of the links

    @classmethod
    def of(cls, robot: Robot, combined: Array, free: Sequence[int]) -> Self | None:
        """Return the prior, or None where the URDF has no masses.

        `combined`, (base, 10 n + rotors), gives the base parameters from the parameters of links and free rotors.
        `free` are the motors of these rotors.
        """
        urdf = robot.tree.inertias.ravel()
        mass = robot.tree.inertias[:, 0]
        if not mass.mean() > 0.0:
            return None
        sizes = _sizes(robot, np.maximum(mass, _LIGHTEST * mass.mean()))
        of_rotors = [10.0 * sizes[motor, 9] for motor in free]
        scale = np.append(sizes.ravel(), of_rotors)
        spread = combined * scale
        covariance = spread @ spread.T
        root = np.linalg.inv(np.linalg.cholesky(covariance))
        # The part of a rotor that no motion separates is counted as the links', so that they explain the whole torque.
        alone = combined[:, : urdf.size] * sizes.ravel()
        gain = (alone * sizes.ravel()).T @ np.linalg.inv(alone @ alone.T)
        return cls(
            mean=combined[:, : urdf.size] @ urdf,
            root=root,
            urdf=urdf,
            gain=gain,
            of_links=combined[:, : urdf.size],
        )

    def completed(self, base: Array) -> Array:
        """Return the inertial parameters with these base parameters that are closest to the URDF's."""
        return np.asarray(self.urdf + self.gain @ (base - self.mean))


def _sizes(robot: Robot, mass: Array) -> Array:
    """Return the possible size of each inertial parameter of a link: its mass at its distance."""
    inertias = robot.tree.inertias
    first = np.linalg.norm(inertias[:, 1:4], axis=1) / mass
    trace = inertias[:, 4] + inertias[:, 6] + inertias[:, 9]
    turning = np.sqrt(np.maximum(0.5 * trace, 0.0) / mass)
    length = np.maximum(np.maximum(first, turning), _SHORTEST)
    return np.column_stack(
        [mass, *((mass * length)[:, None],) * 3, *((mass * length**2)[:, None],) * 6]
    )
