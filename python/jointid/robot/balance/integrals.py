"""The columns of inertia of each joint's torque balance, integrated over windows.

Over a window, the integral of a joint's torque is the change of its momentum, minus the integral of the force of
motion and gravity, plus the integral of friction (see `momentum`). No part of it is an acceleration.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from jointid.balance.windows import Windows
from jointid.robot.links.link_tree import LinkTree
from jointid.robot.links.momentum import columns_of
from jointid.robot.motion.motion import Motion

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]

_PIECE = 1024  # samples in one step: their columns fit into the processor's cache


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class InertiaIntegrals:
    """Integrals of a joint's balance per inertial parameter, for each of its usable windows."""

    links: tuple[int, ...]  # links that the joint carries
    columns: Array  # (windows, 10 * links)


def inertia_integrals(
    tree: LinkTree, motion: Motion, usable: Flags, windows: Windows
) -> list[InertiaIntegrals]:
    """Return each joint's integrals per inertial parameter of the links that it carries, over its usable intervals."""
    pairs, count = tree.pairs, len(windows.edges) - 1
    total = np.zeros((len(pairs), 10, count))
    rows = np.array([joint for joint, _ in pairs])
    step = np.diff(motion.time)
    intervals = step.size
    for first in range(0, intervals, _PIECE):
        last = min(first + _PIECE, intervals)
        piece = slice(first, last + 1)
        momentum, force = columns_of(tree, motion.position[:, piece], motion.velocity[:, piece])
        change = np.diff(momentum, axis=2)
        force[..., 1:] += force[..., :-1]
        change -= 0.5 * step[first:last] * force[..., 1:]
        change *= usable[rows, None, first:last]
        low = int(np.searchsorted(windows.edges, first, side="right")) - 1
        high = int(np.searchsorted(windows.edges, last, side="left"))
        starts = np.maximum(windows.edges[low:high] - first, 0)
        total[:, :, low:high] += np.add.reduceat(change, starts, axis=2)
    found = []
    for joint in range(len(tree.names)):
        mine = np.flatnonzero(rows == joint)
        columns = total[mine].reshape(10 * mine.size, count).T
        found.append(
            InertiaIntegrals(links=tuple(pairs[number][1] for number in mine), columns=columns)
        )
    return found
