"""Logs of a plain joint: sines, a constant inertia, Coulomb and viscous friction, computed in closed form."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

import jointid as jid

Array = NDArray[np.float64]
INERTIA, COULOMB, VISCOUS = 0.5, 3.0, 1.2


def motion(
    duration: float = 12.0, period: float = 0.005, *, amplitude: float = 0.8, seed: int = 0
) -> tuple[Array, Array, Array, Array]:
    """Time, position, velocity and acceleration of three sines."""
    rng = np.random.default_rng(seed)
    time = np.arange(0.0, duration, period)
    signals = np.zeros((3, len(time)))
    for share, rate in zip(
        (1.0, 0.4, 0.1), rng.uniform((0.9, 2.5, 5.0), (1.4, 3.5, 8.0)), strict=True
    ):
        phase = rng.uniform(0.0, 2.0 * np.pi)
        angle = rate * time + phase
        signals += (
            amplitude
            * share
            * np.array([np.sin(angle), rate * np.cos(angle), -(rate**2) * np.sin(angle)])
        )
    return time, *signals


def torque(
    velocity: Array, acceleration: Array, coulomb: float = COULOMB, viscous: float = VISCOUS
) -> Array:
    """The drive's torque."""
    return INERTIA * acceleration + coulomb * np.sign(velocity) + viscous * velocity


def recorded(
    *,
    name: str = "",
    noise: float = 0.02,
    seed: int = 0,
    metadata: dict[str, Any] | None = None,
    **of_motion: Any,
) -> jid.Recording:
    """A clean log."""
    time, position, velocity, acceleration = motion(seed=seed, **of_motion)
    rng = np.random.default_rng(seed + 1000)
    return jid.Recording(
        time=time,
        position=position,
        velocity=velocity,
        torque=torque(velocity, acceleration) + noise * rng.normal(size=len(time)),
        name=name,
        metadata=metadata or {},
    )
