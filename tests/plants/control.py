"""What the simulated controllers see, and what they command, for all runs at once."""

from __future__ import annotations

from typing import Any

import numpy as np

from plants.columns import Array
from plants.law import Law
from plants.log import Log

_TURN = 2.0 * np.pi


class Sensors:
    """The measured signals of all runs.

    Attributes
    ----------
    position, velocity, torque : ndarray, shape (runs,)
        As measured; the torque is the reading as a torque of the link.
    """

    def __init__(self, log: Log, period: Any, position: Array, velocity: Array) -> None:
        self._log, self._period = log, period
        cutoff = np.where(log.velocity_cutoff > 0.0, log.velocity_cutoff, 1.0)
        filtered = 1.0 - np.exp(-_TURN * cutoff * period)
        self._follow = np.where(log.velocity_cutoff > 0.0, filtered, 1.0)
        self._quantum = np.where(log.counts > 0.0, _TURN / np.maximum(log.counts, 1.0), 1.0)
        self.position, self.velocity = position.copy(), velocity.copy()
        self.torque = np.zeros_like(position)
        self._before: Array | None = None
        self._rippled = bool(np.any(log.ripple) or np.any(log.nonlinearity))

    @property
    def reading(self) -> Array:
        """Of the torque sensor, raw."""
        return np.asarray((self.torque - self._log.offset) / self._log.gain)

    def measure(
        self, position: Array, velocity: Array, link: Array, noise: tuple[Array, ...], now: Array
    ) -> None:
        """Take a sample; `now` says which runs take one of the velocity."""
        log = self._log
        self.torque = link + noise[0]
        if self._rippled:
            ripple = log.ripple * np.sin(log.ripple_order * position + log.ripple_phase)
            torque = self.torque + ripple
            self.torque = (
                torque + log.nonlinearity * log.full_scale * (torque / log.full_scale) ** 3
            )
        seen = position + noise[2]
        rounded = self._quantum * np.floor(seen / self._quantum)
        self.position = np.where(log.counts > 0.0, rounded, seen)
        if self._before is None:  # the start is known
            self._before = self.position
            return
        if now.any():
            difference = (self.position - self._before) / self._period
            raw = np.where(log.differenced > 0.0, difference, velocity + noise[1])
            followed = self.velocity + self._follow * (raw - self.velocity)
            self.velocity = np.where(now, followed, self.velocity)
            self._before = np.where(now, self.position, self._before)


class Controller:
    """The `Law` of all runs, with its state."""

    def __init__(self, law: Law, tick: float) -> None:
        self._law, self._period = law, law.every * tick
        self._integral = np.zeros(np.size(law.every))
        self._command = np.zeros(np.size(law.every))

    def command(self, seen: Sensors, wanted: tuple[Array, Array, Array], now: Array) -> Array:
        """The held torque of every run; new where `now`."""
        if not now.any():
            return self._command
        law = self._law
        position, velocity, acceleration = wanted
        error, rate = seen.position - position, seen.velocity - velocity
        self._integral = np.where(now, self._integral + self._period * error, self._integral)
        slip = np.where(law.on_reference > 0.0, velocity, seen.velocity)
        dry = law.coulomb + law.static * np.exp(-law.stribeck * slip**2)
        pulled = acceleration - law.stiffness * (2.0 * rate + law.stiffness * error)
        torque = law.inertia * pulled - law.integral * self._integral
        torque += dry * np.sign(slip) + law.viscous * slip
        # The law's feedback is of the raw reading.
        torque += law.feedback * seen.reading + law.feedback_offset
        torque += law.gravity * np.cos(position + law.gravity_angle)
        limited = np.clip(torque, -law.limit, law.limit)
        self._command = np.where(now, limited, self._command)
        return self._command
