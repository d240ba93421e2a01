"""One step of an arm with set-valued dry friction, so that a joint that sticks stands still."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from jointid.robot.rollout.arm import Arm

Array = NDArray[np.float64]

_SWEEPS = 50  # of projected Gauss-Seidel; a few are enough to converge
_SETTLED = 1e-10


@dataclass(frozen=True, slots=True)
class State:
    """Positions, velocities and the last accelerations of the joints."""

    position: Array
    velocity: Array
    acceleration: Array


@dataclass(frozen=True, slots=True)
class Push:
    """Torques of the joints, and their decrease per increase of speed."""

    torque: Array
    damping: Array


def moved(arm: Arm, state: State, push: Push, duration: float) -> State:
    """Return the state after a duration [s].

    The load of the gears uses the acceleration of the previous step.
    """
    position, velocity = state.position, state.velocity
    mass = arm.mass(position) + duration * np.diag(push.damping)
    free = velocity + duration * np.linalg.solve(mass, push.torque - arm.bias(position, velocity))
    rows = arm.friction_rows()
    if rows.size:
        loaded = arm.friction_under_load(position, velocity, state.acceleration)
        reach = duration * arm.friction_sizes(velocity, loaded)
        impulses = np.linalg.solve(mass, rows.T)
        free = free + impulses @ _impulse(rows @ impulses, rows @ free, reach)
    return State(position + duration * free, free, (free - velocity) / duration)


def _impulse(response: Array, speeds: Array, reach: Array) -> Array:
    """Return impulses within their limits that stop the speeds, or that act against them with the full limit."""
    found = -np.sign(speeds) * reach
    if (np.sign(speeds + response @ found) == np.sign(speeds)).all():
        return np.asarray(found)  # no joint comes to rest
    diagonal = np.diag(response)
    for _ in range(_SWEEPS):
        before = found.copy()
        for k in range(len(found)):
            wanted = found[k] - (speeds[k] + response[k] @ found) / diagonal[k]
            found[k] = min(max(wanted, -reach[k]), reach[k])
        if np.abs(found - before).max() <= _SETTLED * max(float(reach.max()), 1e-300):
            break
    return np.asarray(found)
