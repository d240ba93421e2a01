"""Drive torque that overcomes a simulated joint's friction, from the core's table of terms."""

from __future__ import annotations

import functools

import numpy as np

from jointid import _core


@functools.cache
def _rows() -> dict[str, _core.Term]:
    """Return one row for each basis that a simulated joint may have."""
    return {term.basis: term for term in _core.terms() if term.friction and term.side == 0}


def largest_viscous(joint: _core.SimulatedJoint) -> float:
    """Return the friction per speed, for the direction with more of it."""
    linear = [(one, other) for basis, one, other, _ in joint.friction if basis == "linear"]
    return max(sum(one for one, _ in linear), sum(other for _, other in linear))


def largest_other(joint: _core.SimulatedJoint, speed: float) -> float:
    """Return the other friction at rest or at a speed, for the direction with more of it [N·m]."""
    sums = [0.0, 0.0]
    for basis, *sides, shapes in joint.friction:
        if basis == "linear":
            continue
        row = _rows()[basis]
        own = np.array(shapes[: len(row.shapes)])
        most = max(row.at_rest, float(_core.friction_basis(row.key, np.array([speed]), own)[0]))
        sums = [total + most * side for total, side in zip(sums, sides, strict=True)]
    return max(sums)


def step_at_reversal(joint: _core.SimulatedJoint) -> float:
    """Return the change of friction when the velocity changes its sign [N·m]."""
    return sum(_rows()[basis].at_rest * (one + other) for basis, one, other, _ in joint.friction)


def faded_speed(joint: _core.SimulatedJoint) -> float:
    """Return the speed at which static friction has faded; 0 without static friction."""
    speeds = [0.0]
    for basis, _, _, shapes in joint.friction:
        for name, value in zip(_rows()[basis].shapes, shapes, strict=False):
            power = _core.shape(name).speed_power
            if power and value > 0.0:
                speeds.append(value ** (1.0 / power))
    return max(speeds)
