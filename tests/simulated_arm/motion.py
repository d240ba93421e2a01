"""Motions: sums of sines with many reversals, from standstill."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from simulated_arm.arm import JOINTS, Array

PERIOD = 1e-3  # of control, and of the recording [s]
_FADE = 1.0  # from standstill to the full motion [s]


@dataclass(frozen=True)
class Motion:
    """Reference at each tick of control, (ticks, joints)."""

    time: Array
    position: Array
    velocity: Array
    acceleration: Array


def random_motion(
    seed: int, *, duration: float = 20.0, speed: float = 1.5, base: float = 0.1, sines: int = 7
) -> Motion:
    """Sines at multiples of `base` [Hz] about a posture; each joint's peak is .8 to 1.2 of `speed` [rad/s]."""
    rng = np.random.default_rng([seed, 11])
    time = np.arange(0.0, duration + 0.5 * PERIOD, PERIOD)
    rates = 2.0 * np.pi * base * np.arange(1, sines + 1)
    size = rng.uniform(0.3, 1.0, (JOINTS, sines)) / np.sqrt(rates / rates[0])
    phase = rng.uniform(0.0, 2.0 * np.pi, (JOINTS, sines))
    turn = np.linspace(0.0, 2.0 * np.pi, 1000)[:, None, None] * np.arange(1, sines + 1)
    peak = np.abs((size * np.cos(turn + phase)).sum(axis=2)).max(axis=0)
    size *= (speed * rng.uniform(0.8, 1.2, JOINTS) / peak)[:, None]
    angle = rates * time[:, None, None] + phase
    centre = rng.uniform(-0.5, 0.5, JOINTS)
    position = centre + (size / rates * np.sin(angle)).sum(axis=2)
    velocity = (size * np.cos(angle)).sum(axis=2)
    acceleration = -(size * rates * np.sin(angle)).sum(axis=2)
    return _faded(time, position, velocity, acceleration)


def _faded(time: Array, position: Array, velocity: Array, acceleration: Array) -> Motion:
    """The motion by a clock that starts slowly: t' = w(t), w' rises from 0 to 1."""
    share = np.clip(time / _FADE, 0.0, 1.0)
    rate = share**3 * (10.0 - 15.0 * share + 6.0 * share**2)
    change = 30.0 * share**2 * (1.0 - share) ** 2 / _FADE
    clock = np.where(
        time < _FADE,
        _FADE * (2.5 * share**4 - 3.0 * share**5 + share**6),
        time - 0.5 * _FADE,
    )

    def at(values: Array) -> Array:
        return np.column_stack([np.interp(clock, time, column) for column in values.T])

    fast, faster = at(velocity), at(acceleration)
    return Motion(
        time,
        at(position),
        fast * rate[:, None],
        faster * rate[:, None] ** 2 + fast * change[:, None],
    )
