"""What small changes of given facts add to the balances of all joints, integrated over their windows.

Momentum and force are computed anew with a fact a little otherwise, of fewer samples: the change is smooth.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from jointid.robot.balance import Balance
from jointid.robot.link_tree import LinkTree
from jointid.robot.momentum import columns_of
from jointid.robot.motion import Motion

Array = NDArray[np.float64]

_SAMPLES = 1500  # of a piece
_NEAR = 1e-3  # [rad or m]


def moved_zeros(
    tree: LinkTree, balance: Balance, motions: Mapping[int, Motion], inertial: Array
) -> Array:
    """Change of each row's integral per change of each joint's zero, shape (rows of the pieces, n).

    Parameters
    ----------
    tree : LinkTree
    balance : Balance
    motions : mapping of int to Motion
        Pieces of the balance, by number; only their rows are returned, in their order.
    inertial : ndarray, shape (10 n,)
        Inertial parameters of all links.
    """
    n = len(tree.names)

    def change(motion: Motion) -> list[tuple[Array, Array]]:
        place, speed = motion.position, motion.velocity
        base = _mechanics(tree, place, speed, inertial)
        return [
            tuple(
                (a - b) / _NEAR
                for a, b in zip(
                    _mechanics(tree, place + _NEAR * unit[:, None], speed, inertial),
                    base,
                    strict=True,
                )
            )
            for unit in np.eye(n)
        ]

    return _integrated(balance, motions, change, n)


def tilted_gravity(
    tree: LinkTree, balance: Balance, motions: Mapping[int, Motion], inertial: Array, ways: Array
) -> Array:
    """Change of each row's integral per further gravity along each of some ways, shape (rows, ways).

    Parameters
    ----------
    ways : ndarray, shape (ways, 3)
        In the base's frame.
    """

    def change(motion: Motion) -> list[tuple[Array, Array]]:
        still = np.zeros_like(motion.velocity)
        return [
            _mechanics(replace(tree, gravity=way), motion.position, still, inertial) for way in ways
        ]

    return _integrated(balance, motions, change, len(ways))


def _mechanics(
    tree: LinkTree, position: Array, velocity: Array, inertial: Array
) -> tuple[Array, Array]:
    """Momenta and forces of all joints, (n, samples)."""
    momentum, force = columns_of(tree, position, velocity)
    found = np.zeros((2, *position.shape))
    for number, (joint, link) in enumerate(tree.pairs):
        mine = inertial[10 * link : 10 * link + 10]
        found[0, joint] += mine @ momentum[number]
        found[1, joint] += mine @ force[number]
    return found[0], found[1]


def _integrated(balance, motions, change, count):
    rows = balance.rows
    kept = np.flatnonzero(np.isin(rows.piece, list(motions)))
    found = np.zeros((kept.size, count))
    for number, motion in motions.items():
        every = max(1, motion.time.size // _SAMPLES)
        some = np.unique(np.append(np.arange(0, motion.time.size, every), motion.time.size - 1))
        thin = replace(motion, position=motion.position[:, some], velocity=motion.velocity[:, some])
        summing = balance.summings[number]
        for column, (momentum, force) in enumerate(change(thin)):
            for joint in range(len(momentum)):
                if not (momentum[joint].any() or force[joint].any()):
                    continue
                p = np.interp(motion.time, motion.time[some], momentum[joint])
                f = np.interp(motion.time, motion.time[some], force[joint])
                mine = (rows.piece[kept] == number) & (rows.joint[kept] == joint)
                values = np.diff(p) - 0.5 * summing.step * (f[1:] + f[:-1])
                found[mine, column] = summing(joint, values)[rows.window[kept][mine]]
    return found
