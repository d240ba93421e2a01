"""Changes of the balances of all joints with small changes of facts, integrated over their windows.

Momentum and force are computed again with a slightly changed fact, at fewer samples, because the change is smooth.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from jointid.robot.balance.balance import Balance
from jointid.robot.fit.excerpt_rows import ExcerptRows
from jointid.robot.links.link_tree import LinkTree
from jointid.robot.links.momentum import columns_of
from jointid.robot.motion.motion import Motion

Array = NDArray[np.float64]

_SAMPLES = 1500  # samples of a piece
_NEAR = 1e-3  # [rad or m], change of a zero


def moved_zeros(
    tree: LinkTree,
    balance: Balance,
    rows: ExcerptRows,
    motions: Mapping[int, Motion],
    inertial: Array,
) -> Array:
    """Return the change of each row's integral per change of each joint's zero, (rows, n); motions: of the rows."""
    n = len(tree.names)

    def changes(motion: Motion) -> list[tuple[Array, Array]]:
        place, speed = motion.position, motion.velocity
        momentum, force = _mechanics(tree, place, speed, inertial)
        found = []
        for joint in range(n):
            moved = place.copy()
            moved[joint] += _NEAR
            other = _mechanics(tree, moved, speed, inertial)
            found.append(((other[0] - momentum) / _NEAR, (other[1] - force) / _NEAR))
        return found

    return _integrated(balance, rows, motions, changes, n)


def tilted_gravity(
    tree: LinkTree,
    balance: Balance,
    rows: ExcerptRows,
    motions: Mapping[int, Motion],
    inertial: Array,
    axes: Array,
) -> Array:
    """Return the change of each row's integral per further gravity along some axes, (axes, 3) in the base's frame."""

    def changes(motion: Motion) -> list[tuple[Array, Array]]:
        still = np.zeros_like(motion.velocity)
        return [
            _mechanics(replace(tree, gravity=axis), motion.position, still, inertial)
            for axis in axes
        ]

    return _integrated(balance, rows, motions, changes, len(axes))


def _mechanics(
    tree: LinkTree, position: Array, velocity: Array, inertial: Array
) -> tuple[Array, Array]:
    """Return momenta and forces of all joints, (n, samples)."""
    momentum, force = columns_of(tree, position, velocity)
    found = np.zeros((2, *position.shape))
    for number, (joint, link) in enumerate(tree.pairs):
        mine = inertial[10 * link : 10 * link + 10]
        found[0, joint] += mine @ momentum[number]
        found[1, joint] += mine @ force[number]
    return found[0], found[1]


def _integrated(
    balance: Balance,
    rows: ExcerptRows,
    motions: Mapping[int, Motion],
    changes: Callable[[Motion], list[tuple[Array, Array]]],
    count: int,
) -> Array:
    """Return the integrals over the rows' windows of changed momenta and forces, known at fewer samples."""
    found = np.zeros((rows.kept.size, count))
    for piece, motion in motions.items():
        time, summing = motion.time, balance.summings[piece]
        every = max(1, time.size // _SAMPLES)
        some = np.unique(np.append(np.arange(0, time.size, every), time.size - 1))
        thin = replace(motion, position=motion.position[:, some], velocity=motion.velocity[:, some])
        for column, (momentum, force) in enumerate(changes(thin)):
            for joint in np.flatnonzero(momentum.any(axis=1) | force.any(axis=1)).tolist():
                mine = rows.places(piece, joint)
                change = np.diff(np.interp(time, time[some], momentum[joint]))
                pushed = np.interp(time, time[some], force[joint])
                change -= 0.5 * summing.step * (pushed[1:] + pushed[:-1])
                found[mine, column] = summing(joint, change)[rows.window[mine]]
    return found
