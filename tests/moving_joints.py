"""Torques of joints along given motions, with known friction and, where asked, a coupling: no simulator needed."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

import jointid as jid

Array = npt.NDArray[np.float64]
PERIOD = 0.002


@dataclass(frozen=True)
class Motion:
    """Position, velocity and acceleration of joints, each of shape (samples, joints)."""

    time: Array
    position: Array
    velocity: Array
    acceleration: Array


def sines(joints: int, seed: int, duration: float = 12.0, alike: bool = False) -> Motion:
    """Sums of five sines a joint, of random frequencies and phases; the same frequencies for all if alike."""
    random = np.random.default_rng(seed)
    time = np.arange(0.0, duration, PERIOD)
    shared = 2.0 * np.pi * random.uniform(0.1, 1.2, 5)
    parts = []
    for _ in range(joints):
        rates = shared if alike else 2.0 * np.pi * random.uniform(0.1, 1.2, 5)
        size = random.uniform(0.2, 1.0, 5) / rates
        phase = rates * time[:, None] + random.uniform(0.0, 2.0 * np.pi, 5)
        parts.append(
            (
                (size * np.sin(phase)).sum(axis=1),
                (size * rates * np.cos(phase)).sum(axis=1),
                -(size * rates**2 * np.sin(phase)).sum(axis=1),
            )
        )
    q, v, a = (np.column_stack(each) for each in zip(*parts, strict=True))
    return Motion(time, q, v, a)


def torques(motion: Motion, seed: int, *, noise: float = 0.3, unmodelled: float = 0.0) -> Array:
    """Torque of each joint by itself; `unmodelled` adds what no friction model here has, of this size [N·m]."""
    random = np.random.default_rng([seed, 1])
    q, v = motion.position, motion.velocity
    joints = q.shape[1]
    inertia = random.uniform(0.5, 2.0, joints)
    coulomb, viscous = random.uniform(3.0, 8.0, joints), random.uniform(2.0, 8.0, joints)
    torque = inertia * motion.acceleration + coulomb * np.sign(v) + viscous * v
    phase = random.uniform(0.0, 2.0 * np.pi, joints)
    torque += unmodelled * np.sin(3.0 * q + phase)  # a cable, an uneven gear
    torque += unmodelled * np.sign(v) * np.exp(-np.abs(v) / 0.1)
    torque += 0.5 * unmodelled * np.sin(0.5 * motion.time[:, None] + phase)  # it warms up
    return np.asarray(torque + noise * random.standard_normal(torque.shape))


def recorded(motion: Motion, torque: Array, **fields: object) -> jid.RobotRecording:
    """The recording of such joints, with positions only."""
    return jid.RobotRecording(
        time=motion.time,
        position=motion.position,
        torque=torque,
        **fields,  # type: ignore[arg-type]
    )
