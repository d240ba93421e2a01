"""A robot's links as numbers: how they hang on each other, where they are, what they weigh."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

INERTIAL = ("m", "mx", "my", "mz", "Ixx", "Ixy", "Iyy", "Ixz", "Iyz", "Izz")
"""The inertial parameters of a link, in its own frame: mass, first moments, inertia about the frame's origin."""
INERTIAL_UNITS = ("kg", *("kg·m",) * 3, *("kg·m²",) * 6)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class LinkTree:
    """Links and the joints of one degree of freedom that move them; link k is moved by joint k."""

    names: tuple[str, ...]  # of the joints
    # link that each joint sits on, before its own; -1: the base, which stands still
    parents: tuple[int, ...]
    rotations: Array  # (n, 3, 3), of a joint's frame at position 0, to its parent's frame
    translations: Array  # (n, 3) [m]
    axes: Array  # (n, 3), unit vectors in the joint's own frame
    prismatic: tuple[bool, ...]  # whether a joint slides along its axis
    inertias: Array  # (n, 10), in the order of `INERTIAL`
    gravity: Array  # (3,), acceleration in the base's frame [m/s²]
    # joints that move and are left out; they stand at 0. Not known of a robot that was read from JSON
    locked: tuple[str, ...] = ()
    # how far each joint may move by the URDF's limits [rad or m]; None: not known
    spans: tuple[float, ...] | None = None

    @property
    def pairs(self) -> tuple[tuple[int, int], ...]:
        """Each joint with each link that it carries, as (joint, link), in the links' order."""
        return tuple((i, k) for k in range(len(self.names)) for i in self.carriers(k))

    def carriers(self, link: int) -> tuple[int, ...]:
        """Joints between the base and a link, the base's side first."""
        found: list[int] = []
        while link >= 0:
            found.append(link)
            link = self.parents[link]
        return tuple(reversed(found))
