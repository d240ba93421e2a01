"""The torque balance of each joint, integrated over windows: columns of inertia, of friction, and the torque.

Over a window, the integral of a joint's torque is the change of its momentum, less the integral of the force that its
motion and gravity exert, plus that of friction (see `momentum`). No piece of it is an acceleration.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from jointid.robot.link_tree import LinkTree
from jointid.robot.momentum import columns_of
from jointid.robot.motion import Motion

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]

_PIECE = 1024  # samples at a time: their columns stay in the processor's cache
_LEAST = 0.2  # of a window that has to be usable


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Windows:
    """Equal windows over the stretches of a recording without a gap."""

    # (windows + 1,), first interval of each; windows with a gap are as others, with nothing usable there
    edges: NDArray[np.int64]
    duration: float  # usual length [s]

    @classmethod
    def of(cls, time: Array, duration: float) -> Windows:
        """Return windows of about this duration [s]."""
        count = max(1, round(float(time[-1] - time[0]) / duration))
        instants = np.linspace(time[0], time[-1], count + 1)
        edges = np.unique(np.searchsorted(time, instants[:-1], side="left"))
        edges = edges[edges < time.size - 1]
        return cls(edges=np.append(edges, time.size - 1), duration=duration)

    def summed(self, intervals: Array) -> Array:
        """Return sums over the windows, along the last axis."""
        return np.add.reduceat(intervals, self.edges[:-1], axis=-1)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class InertiaIntegrals:
    """Integrals of a joint's balance by inertial parameters, for each of its usable windows."""

    links: tuple[int, ...]  # that the joint carries
    columns: Array  # (windows, 10 * links)


def inertia_integrals(
    tree: LinkTree, motion: Motion, usable: Flags, windows: Windows
) -> list[InertiaIntegrals]:
    """Return each joint's integrals by inertial parameters of the links that it carries, over its usable intervals."""
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


def torque_integrals(torque: Array, step: Array, held: bool) -> Array:
    """Integrals over the intervals of a torque that is held from its sample on, or straight between samples."""
    if held:
        return np.asarray(step * torque[..., :-1])
    return np.asarray(0.5 * step * (torque[..., 1:] + torque[..., :-1]))


def direction_integrals(velocity: Array, step: Array) -> Array:
    """Integrals of the velocity's sign over the intervals; within a reversal at the instant that the speeds show."""
    before, after = velocity[..., :-1], velocity[..., 1:]
    speed = np.abs(before) + np.abs(after)
    share = (before + after) / np.where(speed > 0.0, speed, 1.0)
    return np.where(before * after < 0.0, share, 0.5 * (np.sign(before) + np.sign(after))) * step


def interval_means(signal: Array, velocity: Array) -> Array:
    """Means over the intervals; within a reversal by the share of time on each side, as `direction_integrals`."""
    speed = np.abs(velocity)
    before, after = signal[:-1], signal[1:]
    total = speed[:-1] + speed[1:]
    share = speed[:-1] / np.where(total > 0.0, total, 1.0)
    turned = before * after < 0.0
    return np.where(turned, share * before + (1.0 - share) * after, 0.5 * (before + after))
