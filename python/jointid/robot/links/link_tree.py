"""A robot's links as numbers: their connections, positions and inertias."""

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
    """Links and the joints of one degree of freedom that move them; joint k moves link k."""

    names: tuple[str, ...]  # of the joints
    # parent link of each joint, an earlier one; -1: the base, which does not move
    parents: tuple[int, ...]
    rotations: Array  # (n, 3, 3), from a joint's frame at position 0 to its parent's frame
    translations: Array  # (n, 3) [m]
    axes: Array  # (n, 3), unit vectors in the joint's own frame
    prismatic: tuple[bool, ...]  # whether a joint slides along its axis
    inertias: Array  # (n, 10), in the order of `INERTIAL`
    gravity: Array  # (3,), acceleration in the base's frame [m/s²]
    # moving joints of the URDF that are left out; they stay at 0. Unknown for a robot that was read from JSON
    locked: tuple[str, ...] = ()
    # range of each joint by the URDF's limits [rad or m]; None: unknown
    spans: tuple[float, ...] | None = None

    @property
    def pairs(self) -> tuple[tuple[int, int], ...]:
        """Each joint with each link that it carries, as (joint, link), in the links' order."""
        return tuple((i, k) for k in range(len(self.names)) for i in self.carriers(k))

    def carriers(self, link: int) -> tuple[int, ...]:
        """Return the joints between the base and a link, from the base on."""
        found: list[int] = []
        while link >= 0:
            found.append(link)
            link = self.parents[link]
        return tuple(reversed(found))
