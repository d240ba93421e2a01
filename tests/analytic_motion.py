"""Recordings of a joint whose motion and torque are formulas: inertia 0.5, Coulomb 3, viscous 1.2."""

import numpy as np

import jointid as jid

TRUE = {"inertia": 0.5, "coulomb": 3.0, "viscous": 1.2}


def two_sines(
    period: float = 0.005, *, wide: float = 1.2, seed: int = 0, duration: float = 20.0
) -> jid.Recording:
    """Two sines, torque with noise of 0.02 N·m; with the velocity."""
    time = np.arange(0.0, duration, period)
    position = wide * np.sin(1.3 * time) + 0.4 * np.sin(3.7 * time)
    velocity = 1.3 * wide * np.cos(1.3 * time) + 1.48 * np.cos(3.7 * time)
    acceleration = -1.69 * wide * np.sin(1.3 * time) - 5.476 * np.sin(3.7 * time)
    torque = 0.5 * acceleration + 3.0 * np.sign(velocity) + 1.2 * velocity
    noise = 0.02 * np.random.default_rng(seed).standard_normal(len(time))
    return jid.Recording(time=time, position=position, velocity=velocity, torque=torque + noise)


def worst(estimate: jid.Estimate) -> float:
    """Largest relative error of the estimate's values."""
    return max(abs(estimate[name].value / true - 1.0) for name, true in TRUE.items())
