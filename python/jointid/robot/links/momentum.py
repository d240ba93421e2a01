"""Momentum and forces of a moving tree of links as columns of its inertial parameters, for many samples at once.

Lagrange's equation gives the torque of the joints: ``d/dt (∂T/∂v) - ∂T/∂q + ∂U/∂q``. Both parts are linear in the
links' inertial parameters, and need position and velocity only. Let the axis S of joint i and the velocity V of link k
be spatial vectors in the frame of link k. Then momentum is ``S · h``, ``∂T/∂q`` is ``(V_i x S) · h``, and ``∂U/∂q`` is
``-S · f``. Here h is the spatial momentum of the link, and f the momentum of a link with gravity as its velocity.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from jointid.robot.links.link_tree import LinkTree

Array = NDArray[np.float64]
Spatial = tuple[Array, Array]  # linear part at the frame's origin, angular part; both (3, samples)


def columns_of(tree: LinkTree, position: Array, velocity: Array) -> tuple[Array, Array]:
    """Return the columns of momentum and of force, (pairs, 10, samples), in the order of `LinkTree.pairs`.

    They are columns of the link's inertial parameters. The force is ``∂T/∂q - ∂U/∂q``. The rate of the momentum is the
    torque plus this force.
    """
    samples = position.shape[1]
    pairs = tree.pairs
    momentum, force = np.empty((2, len(pairs), 10, samples))
    zero = np.zeros((3, samples))
    still: Spatial = (zero, zero)
    down: Spatial = (np.repeat(tree.gravity[:, None], samples, axis=1), zero)
    velocities: list[Spatial] = []
    gravities: list[Spatial] = []
    # Axes of the carrying joints and their rates V x S, in each link's own frame.
    axes: list[dict[int, tuple[Spatial, Spatial]]] = []
    number = 0
    for k, parent in enumerate(tree.parents):
        turned, shift = _placement(tree, k, position[k])
        axis = _axis(tree, k, samples)
        carried = _moved(velocities[parent] if parent >= 0 else still, turned, shift)
        own = (carried[0] + axis[0] * velocity[k], carried[1] + axis[1] * velocity[k])
        gravities.append(_moved(gravities[parent] if parent >= 0 else down, turned, shift))
        velocities.append(own)
        inherited = axes[parent] if parent >= 0 else {}
        mine = {
            i: (_moved(s, turned, shift), _moved(rate, turned, shift))
            for i, (s, rate) in inherited.items()
        }
        mine[k] = (axis, _crossed(carried, axis))
        axes.append(mine)
        for i in tree.carriers(k):
            s, rate = mine[i]
            _product(s, own, momentum[number])
            _product(rate, own, force[number])
            force[number] += _product(s, gravities[k], np.empty((10, samples)))
            number += 1
    return momentum, force


def _placement(tree: LinkTree, k: int, position: Array) -> tuple[Array, Array]:
    """Return rotation (3, 3, samples) and origin (3, samples) of a link's frame in its parent's."""
    rotation, origin, axis = tree.rotations[k], tree.translations[k], tree.axes[k]
    if tree.prismatic[k]:
        shift = origin[:, None] + (rotation @ axis)[:, None] * position
        return np.repeat(rotation[:, :, None], position.size, axis=2), shift
    x, y, z = axis
    skew = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    outer = rotation @ np.outer(axis, axis)
    turned = (
        outer[:, :, None]
        + (rotation - outer)[:, :, None] * np.cos(position)
        + (rotation @ skew)[:, :, None] * np.sin(position)
    )
    return turned, np.repeat(origin[:, None], position.size, axis=1)


def _axis(tree: LinkTree, k: int, samples: int) -> Spatial:
    axis = np.repeat(tree.axes[k][:, None], samples, axis=1)
    zero = np.zeros((3, samples))
    return (axis, zero) if tree.prismatic[k] else (zero, axis)


def _moved(vector: Spatial, turned: Array, shift: Array) -> Spatial:
    """Return a parent's spatial motion vector in its child's frame."""
    linear, angular = vector
    linear = linear + _cross(angular, shift)
    return _back(turned, linear), _back(turned, angular)


def _back(turned: Array, vector: Array) -> Array:
    """Return the transposed rotation times the vector."""
    result: Array = turned[0] * vector[0]
    result += turned[1] * vector[1]
    result += turned[2] * vector[2]
    return result


def _cross(a: Array, b: Array) -> Array:
    result = np.empty_like(a)
    for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        np.multiply(a[j], b[k], out=result[i])
        result[i] -= a[k] * b[j]
    return result


def _crossed(a: Spatial, b: Spatial) -> Spatial:
    """Return the spatial cross product of two motion vectors."""
    return _cross(a[1], b[0]) + _cross(a[0], b[1]), _cross(a[1], b[1])


def _product(s: Spatial, v: Spatial, result: Array) -> Array:
    """Return ``s · (inertia v)`` per inertial parameter (ten)."""
    (sl, sa), (vl, va) = s, v
    result[0] = sl[0] * vl[0] + sl[1] * vl[1] + sl[2] * vl[2]
    result[1:4] = _cross(sl, va)
    result[1:4] += _cross(vl, sa)
    result[4] = sa[0] * va[0]
    result[5] = sa[0] * va[1] + sa[1] * va[0]
    result[6] = sa[1] * va[1]
    result[7] = sa[0] * va[2] + sa[2] * va[0]
    result[8] = sa[1] * va[2] + sa[2] * va[1]
    result[9] = sa[2] * va[2]
    return result
