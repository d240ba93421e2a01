"""The arm in closed loop: computed torque and stiffness about a motion, friction with any value at standstill.

Between reversals a step is the explicit midpoint rule: each source that turns keeps its sign, one that stands still is
held by a torque within its static friction. Where a sign would change or that torque is not enough, the step is cut
into parts of implicit time stepping: friction's impulses are bounded, and found by projected Gauss-Seidel.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from simulated_arm.arm import Arm, Array
from simulated_arm.motion import PERIOD, Motion

_PARTS = 8  # of a step in which a source reverses
_SWEEPS = 40
_STILL = 1e-9  # [rad/s]
_BANDWIDTH = 30.0  # of the position loop [rad/s]


@dataclass(frozen=True)
class Run:
    """True signals at each tick, (ticks, joints); the torque is held until the next tick."""

    arm: Arm
    time: Array
    position: Array
    velocity: Array
    torque: Array


class _Dynamics:
    """Acceleration and impulses of one arm; arrays are made once."""

    def __init__(self, arm: Arm) -> None:
        import pinocchio

        self._library, self._model = pinocchio, arm.model
        self._state = arm.model.createData()
        self.speeds = arm.speeds
        self._rotors = (self.speeds.T * arm.values("rotor_inertia")) @ self.speeds
        self._viscous = arm.values("viscous")
        self._damping = (self.speeds.T * self._viscous) @ self.speeds
        self._offset = self.speeds.T @ arm.values("offset")
        self._coulomb, self._static = arm.values("coulomb"), arm.values("static")
        self._stribeck = arm.values("stribeck")
        self._upper = np.triu(np.ones_like(self._rotors)) - 0.5 * np.eye(arm.joints)

    def _inertia(self, position: Array) -> Array:
        # The library fills the upper triangle.
        upper = self._library.crba(self._model, self._state, position) * self._upper
        return np.asarray(upper + upper.T + self._rotors)

    def level(self, speed: Array) -> Array:
        """Friction's bound without viscous friction."""
        return self._coulomb + self._static * np.exp(-self._stribeck * speed * speed)

    def acceleration(
        self, position: Array, velocity: Array, torque: Array, sign: Array
    ) -> Array | None:
        """With each source's sign; one of sign 0 is held. None if that takes more than its static friction."""
        speed = self.speeds @ velocity
        level = self.level(speed)
        friction = self.speeds.T @ (sign * level + self._viscous * speed)
        rest = self._library.nonLinearEffects(self._model, self._state, position, velocity)
        drive = torque - rest - friction - self._offset
        inertia = self._inertia(position)
        held = sign == 0.0
        if not held.any():
            return np.asarray(np.linalg.solve(inertia, drive))
        acts = self.speeds[held]
        solved = np.linalg.solve(inertia, np.column_stack([drive, acts.T]))
        # Not `solve`: a motor and both joints that turn it may stand still together.
        holding = np.linalg.lstsq(acts @ solved[:, 1:], acts @ solved[:, 0], rcond=1e-10)[0]
        if np.any(np.abs(holding) > level[held]):
            return None
        return np.asarray(solved[:, 0] - solved[:, 1:] @ holding)

    def part(
        self, position: Array, velocity: Array, torque: Array, step: float
    ) -> tuple[Array, Array]:
        """One implicit step with bounded impulses of friction."""
        rest = self._library.nonLinearEffects(self._model, self._state, position, velocity)
        inertia = self._inertia(position)
        inverse = np.linalg.inv(inertia + step * self._damping)
        free = inverse @ (inertia @ velocity + step * (torque - rest - self._offset))
        yields = self.speeds @ inverse @ self.speeds.T
        bound = (step * self.level(self.speeds @ velocity)).tolist()
        wanted = (self.speeds @ free).tolist()
        impulse = _projected(yields.tolist(), wanted, bound)
        after = free - inverse @ (self.speeds.T @ impulse)
        after[np.abs(after) < _STILL] = 0.0
        return position + 0.5 * step * (velocity + after), after


def _projected(yields: list[list[float]], wanted: list[float], bound: list[float]) -> Array:
    """Impulses within their bounds that bring each speed to 0, or as near to it as the bound allows."""
    count = len(bound)
    found = [0.0] * count
    for _ in range(_SWEEPS):
        change = 0.0
        for i in range(count):
            row = yields[i]
            speed = wanted[i]
            for j in range(count):
                speed -= row[j] * found[j]
            new = min(max(found[i] + speed / row[i], -bound[i]), bound[i])
            change = max(change, abs(new - found[i]) / (bound[i] + 1e-30))
            found[i] = new
        if change < 1e-9:
            break
    return np.array(found)


def commands(arm: Arm, motion: Motion, trust: float) -> Array:
    """Torque for the reference by the arm's own dynamics, `trust` of it, with most of the friction."""
    import pinocchio

    state = arm.model.createData()
    rows = zip(motion.position, motion.velocity, motion.acceleration, strict=True)
    links = np.array([pinocchio.rnea(arm.model, state, *row) for row in rows])
    speed = motion.velocity @ arm.speeds.T
    of_sources = (
        motion.acceleration @ arm.speeds.T * arm.values("rotor_inertia")
        + 0.8 * arm.values("coulomb") * np.tanh(speed / 0.05)
        + arm.values("viscous") * speed
    )
    return np.asarray(trust * (links + of_sources @ arm.speeds))


def run(arm: Arm, motion: Motion, *, trust: float = 0.95, steps: int = 2) -> Run:
    """Let a computed torque with stiffness follow the motion.

    Parameters
    ----------
    arm : Arm
    motion : Motion
    trust : float
        Of the true model's torque, the share that is commanded ahead.
    steps : int
        Of integration, between two commands.
    """
    dynamics = _Dynamics(arm)
    forward = commands(arm, motion, trust)
    size = np.abs(dynamics.speeds.T) @ arm.values("rotor_inertia") + 0.3 * np.linspace(
        1.0, 0.1, arm.joints
    )
    stiffness, damping = size * _BANDWIDTH**2, size * 2.0 * _BANDWIDTH
    ticks = len(motion.time)
    shape = (ticks, arm.joints)
    positions, velocities, torques = np.empty(shape), np.empty(shape), np.empty(shape)
    position, velocity = motion.position[0].copy(), np.zeros(arm.joints)
    step = PERIOD / steps
    for tick in range(ticks):
        torque = (
            forward[tick]
            + stiffness * (motion.position[tick] - position)
            + damping * (motion.velocity[tick] - velocity)
        )
        positions[tick], velocities[tick], torques[tick] = position, velocity, torque
        for _ in range(steps):
            position, velocity = _step(dynamics, position, velocity, torque, step)
    return Run(arm, motion.time, positions, velocities, torques)


def _step(
    dynamics: _Dynamics, position: Array, velocity: Array, torque: Array, step: float
) -> tuple[Array, Array]:
    speed = dynamics.speeds @ velocity
    sign = np.where(np.abs(speed) < _STILL, 0.0, np.sign(speed))
    begin = dynamics.acceleration(position, velocity, torque, sign)
    if begin is not None:
        half = velocity + 0.5 * step * begin
        middle = dynamics.acceleration(position + 0.5 * step * velocity, half, torque, sign)
        if middle is not None:
            after = velocity + step * middle
            after[np.abs(after) < _STILL] = 0.0
            if np.all((sign * (dynamics.speeds @ after) > 0.0) | (sign == 0.0)):
                return position + step * half, after
    for _ in range(_PARTS):
        position, velocity = dynamics.part(position, velocity, torque, step / _PARTS)
    return position, velocity
