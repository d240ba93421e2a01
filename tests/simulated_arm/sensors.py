"""What sensors and a host make of a run: late, quantised, noisy, with stamps of the host's clock."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

import jointid as jid
from simulated_arm.arm import Array
from simulated_arm.motion import PERIOD
from simulated_arm.running import Run


@dataclass(frozen=True, kw_only=True)
class Sensors:
    """All noises are Gaussian but the stamps'; the defaults are an arm with good encoders and a busy host.

    Attributes
    ----------
    stamp_lateness : float
        Mean of the time from a sample to its stamp [s], exponential.
    counts : float
        Of an encoder, a turn of the joint; 0: exact.
    position_noise : float
        [rad]
    velocity_delay : float or None
        [s]; None: velocity is not recorded.
    velocity_noise : float
        [rad/s]
    torque_noise : float
        Share of each joint's largest torque.
    """

    stamp_lateness: float = 5e-5
    counts: float = 2.0**19
    position_noise: float = 0.0
    velocity_delay: float | None = 5e-3
    velocity_noise: float = 2e-3
    torque_noise: float = 5e-3


def recorded(run: Run, sensors: Sensors, seed: int, *, motors: bool = False) -> jid.RobotRecording:
    """The run as a robot's recording, at the joints; with `motors`, behind gears and couplings.

    Parameters
    ----------
    run : Run
    sensors : Sensors
    seed : int
    motors : bool
        Record motors' positions, velocities and torques: θ = C q, τ = C⁻ᵀ τ of the joints.
    """
    rng = np.random.default_rng([seed, 13])
    turns = run.arm.couplings if motors else np.eye(run.arm.joints)
    position = _quantised(run.position, sensors.counts)
    position = position + rng.normal(0.0, 1.0, position.shape) * sensors.position_noise
    noise = rng.normal(0.0, 1.0, run.torque.shape) * np.abs(run.torque).max(axis=0)
    torque = run.torque + sensors.torque_noise * noise
    stamps = run.time + rng.exponential(1.0, len(run.time)) * sensors.stamp_lateness
    stamps = np.maximum.accumulate(stamps) + np.arange(len(stamps)) * 1e-9
    velocity = None
    if sensors.velocity_delay is not None:
        velocity = _late(run.velocity, sensors.velocity_delay)
        velocity = velocity + rng.normal(0.0, 1.0, velocity.shape) * sensors.velocity_noise
        velocity = velocity @ turns.T
    return jid.RobotRecording(
        time=stamps,
        position=position @ turns.T,
        velocity=velocity,
        torque=np.linalg.solve(turns.T, torque.T).T,
        side="motor" if motors else "joint",
        names=[f"joint_{number}" for number in range(1, run.arm.joints + 1)],
        torque_hold="zoh",
        name="seven joints",
    )


def _quantised(position: Array, counts: float) -> Array:
    if not counts:
        return position
    count = 2.0 * np.pi / counts
    return np.asarray(np.round(position / count) * count)


def _late(signal: Array, delay: float) -> Array:
    ticks = np.arange(len(signal)) * PERIOD
    return np.column_stack([np.interp(ticks - delay, ticks, column) for column in signal.T])
