"""Noise of the torque balance that the sensors cause."""

from __future__ import annotations

import math

from jointid import _core
from jointid.excitation.simulated_friction import faded_speed, step_at_reversal
from jointid.joint.joint import Joint

_OWN = 3e-3  # share of the torque limit: default noise of a torque sensor
_COUNTS = 8000.0  # counts per motor revolution: default encoder
_SMOOTHED = 9  # samples from which a velocity is derived
_LEAST = 1e-6  # share of the torque limit: smallest noise of a balance
_SLOW = (
    0.15  # share of the fading speed of static friction, below which noise decides the breakaway
)
_REVERSAL = 0.1  # share of a period: accuracy with which samples show the time of a reversal
_STANDING = 1e-4  # share of the largest speed


def assumed_sensors(joint: Joint, torque: float) -> _core.Sensors:
    """Return the default sensors of a joint: a torque sensor with noise, or a coarse encoder."""
    if joint.sensor:
        return _core.Sensors(torque_noise=_OWN * torque)
    return _core.Sensors(encoder_counts=_COUNTS, velocity="difference")


def noise_of_balance(
    joint: Joint,
    setup: _core.Setup,
    sensors: _core.Sensors,
    *,
    period: float,
    sampled: float,
    torque: float,
    velocity: float,
) -> _core.BalanceNoise:
    """Return the noise of one joint's balance, from the limits of torque [N·m] and velocity [rad/s].

    `period` is the sampling period of the simulation [s], `sampled` that of the recording.
    """
    variance = (_LEAST * torque) ** 2
    if joint.sensor:
        variance += sensors.torque_noise**2
        if sensors.converter_bits > 0:
            count = 2.0 * sensors.converter_range / 2.0**sensors.converter_bits
            spread = sensors.converter_noise**2 / sensors.converter_samples + 1.0 / 12.0
            variance += (setup.sensor_gain * count) ** 2 * spread
    position = 0.0
    if sensors.encoder_counts > 0.0:
        turn = sensors.encoder_counts * abs(joint.gear_ratio)
        position = 2.0 * math.pi / turn / math.sqrt(12.0)
    # Straight line through this number of recorded positions, independent of the judge's step.
    derived = position * math.sqrt(12.0 / _SMOOTHED**3) / sampled
    slowest = max(_STANDING * velocity, 3.0 * derived, _SLOW * faded_speed(setup.joint))
    return _core.BalanceNoise(
        # The noise is white in the recording's samples. Fewer samples are as good as their means.
        torque=math.sqrt(variance * sampled / period),
        position=position,
        velocity=derived,
        slowest=min(slowest, 0.05 * velocity),
        reversal=_REVERSAL * sampled * step_at_reversal(setup.joint),
        sampled=sampled,
    )
