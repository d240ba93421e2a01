"""A small simulator of the thesis's joint in NumPy, many runs side by side; other code than the core's.

Friction is set-valued at rest: a step that would end on the other side of zero speed ends at rest.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

import jointid as jid

Array = NDArray[np.float64]

TRUTH = {
    "coulomb": 25.0,
    "static": 20.0,
    "stribeck": 100.0,
    "viscous": 20.0,
    "sensor_gain": 2.4,
    "sensor_offset": 15.0,
}
INERTIA = 2.472e-4 * 101.0**2  # [kg·m²], reflected
LINK_INERTIA = 3.0 * 0.5**2 / 3.0  # [kg·m²]
GRAVITY = 3.0 * 9.817 * 0.25  # [N·m]
PERIOD = 1e-3  # [s]
FINER = 4  # integration steps a sample


@dataclass(frozen=True)
class Law:
    """Trajectory-following with estimates that are wrong, as before an identification."""

    stiffness: float = 80.0  # [1/s]
    robust: float = 5.05  # [N·m]
    layer: float = 0.9 / 101.0  # [rad/s]
    coulomb: float = 15.0
    static: float = 10.0
    stribeck: float = 150.0
    viscous: float = 10.0
    gain: float = 1.5
    limit: float = 160.0  # [N·m]


def _reference(time: float, amplitude: Array, rate: float) -> tuple[Array, Array, Array]:
    angle = rate * time
    scale = amplitude / 1.3
    return (
        scale * (np.sin(angle) - 0.5 * np.sin(2 * angle)),
        scale * rate * (np.cos(angle) - np.cos(2 * angle)),
        scale * rate**2 * (2 * np.sin(2 * angle) - np.sin(angle)),
    )


def _friction(speed: Array) -> Array:
    decay = np.exp(-TRUTH["stribeck"] * speed**2)
    return np.asarray(TRUTH["coulomb"] + TRUTH["static"] * decay)


def simulate(
    runs: int,
    *,
    duration: float,
    seed: int,
    noise: float = 0.2,
    degrees: tuple[float, float] = (50.0, 70.0),
) -> list[jid.Recording]:
    """Runs about the vertical with other amplitudes and other noise of the sensor [N·m], 3 s a cycle."""
    rng = np.random.default_rng(seed)
    law = Law()
    samples = round(duration / PERIOD)
    amplitude = np.radians(rng.uniform(*degrees, runs))
    rate = 2.0 * np.pi / 3.0
    mass, step = INERTIA + LINK_INERTIA, PERIOD / FINER
    half_viscous = 0.5 * step * TRUTH["viscous"]
    q, v, acceleration = np.zeros(runs), np.zeros(runs), np.zeros(runs)
    log = np.empty((4, samples, runs))
    for k in range(samples):
        link = LINK_INERTIA * acceleration + GRAVITY * np.sin(q)
        reading = (link + rng.normal(0.0, noise, runs) - TRUTH["sensor_offset"]) / TRUTH[
            "sensor_gain"
        ]
        wanted, wanted_speed, wanted_acceleration = _reference(k * PERIOD, amplitude, rate)
        error, error_rate = q - wanted, v - wanted_speed
        pulled = wanted_acceleration - law.stiffness * (2.0 * error_rate + law.stiffness * error)
        dry = law.coulomb + law.static * np.exp(-law.stribeck * v**2)
        torque = INERTIA * pulled + law.viscous * v + dry * np.sign(v) + law.gain * reading
        slide = error_rate + law.stiffness * error
        torque -= law.robust * np.clip(slide / law.layer, -1.0, 1.0)
        torque = np.clip(torque, -law.limit, law.limit)
        log[:, k] = q, v, torque, reading
        for _ in range(FINER):
            middle = q + 0.5 * step * v
            dry = _friction(v + 0.5 * step * acceleration)
            free = (mass - half_viscous) * v + step * (torque - GRAVITY * np.sin(middle))
            # At rest the whole of static friction holds; on the way it brakes.
            dry = np.where(v == 0.0, TRUTH["coulomb"] + TRUTH["static"], dry)
            after = np.sign(free) * np.maximum(np.abs(free) - step * dry, 0.0)
            after /= mass + half_viscous
            after = np.where(v * after < 0.0, 0.0, after)
            acceleration = (after - v) / step
            q, v = q + 0.5 * step * (v + after), after
    time = np.arange(samples) * PERIOD
    return [
        jid.Recording(
            time=time,
            position=log[0, :, i],
            velocity=log[1, :, i],
            torque=log[2, :, i],
            sensor=log[3, :, i],
            torque_hold="zoh",
            truth=TRUTH,
        )
        for i in range(runs)
    ]
