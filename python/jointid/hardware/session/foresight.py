"""Limits that need the joint's values: stopping position, source of energy, torque of the motion."""

from __future__ import annotations

from collections import deque
from typing import Any

import numpy as np

from jointid.hardware.session.drive import Drive
from jointid.hardware.session.limits import SessionLimits
from jointid.hardware.session.moving_joint import MovingJoint
from jointid.hardware.session.options import SessionOptions
from jointid.hardware.session.stop import LimitError
from jointid.simulation.trajectory import FloatArray

# Time from the sample that requires braking until braking acts: the next cycle's command and its latency.
_REACTION = 2.0  # periods
_WATCHED = 0.02  # [s], span over which work and energy are compared
_NOTICED = 0.05  # [rad/s]; the energy of a slower motion is no evidence
_DOUBT = 0.1  # share of the link's weight
_BEYOND = 0.05  # [s], allowed time of a torque beyond the envelope
_SMALL = 0.05  # share of the torque limit, added to the envelope


class Foresight:
    """Checks that need the joint's inertia, gravity or friction.

    Parameters
    ----------
    limits : SessionLimits
    period : float
        Period of the cycles [s].
    joint : MovingJoint
    latency : float
        Latency of a command in the drive and on the bus [s].
    """

    def __init__(
        self, limits: SessionLimits, period: float, joint: MovingJoint, latency: float
    ) -> None:
        self._limits, self._joint = limits, joint
        self._reaction = _REACTION * period + latency
        self._braking = joint.braking(limits.torque)
        self._often = max(2, round(_WATCHED / period))
        self._watched: deque[tuple[float, float]] = deque(maxlen=self._often + 1)
        self._work = 0.0  # of the motor since the start [J]
        self._place: float | None = None
        self._against = self._beyond = 0
        self._longest = max(1, round(_BEYOND / period))
        self._seen: tuple[float, float] | None = None  # position and velocity of the last sample

    def moving(self, position: float, velocity: float, accepted: float) -> None:
        """Check where the joint would stop if braking began now.

        Parameters
        ----------
        position, velocity : float
            [rad], [rad/s]
        accepted : float
            Torque that acts until braking begins [N·m].

        Raises
        ------
        LimitError
        """
        self._seen = position, velocity
        self._stops_inside(position, velocity, accepted)

    def whole(self, positions: FloatArray, velocities: FloatArray) -> None:
        """Check a motion that the joint follows exactly. Where it cannot follow, a session only stops earlier.

        Parameters
        ----------
        positions, velocities : ndarray, shape (n,)
            [rad], [rad/s]

        Raises
        ------
        LimitError
        """
        if self._braking is None:
            return
        stops = positions + np.sign(velocities) * self._way(np.abs(velocities))
        low, high = self._limits.position
        for first in np.flatnonzero(((stops < low) | (stops > high)) & (velocities != 0.0))[:1]:
            self._stops_inside(float(positions[first]), float(velocities[first]), 0.0)

    def _way(self, speed: Any) -> Any:
        """Return the stopping distance [rad] from one or several speeds [rad/s]."""
        assert self._braking is not None
        return speed * self._reaction + speed * speed / (2.0 * self._braking[1])

    def unseen(self, age: float, accepted: float) -> None:
        """Check in a cycle without a sample where the joint would stop.

        Parameters
        ----------
        age : float
            Time since the last sample [s].
        accepted : float
            Torque that has acted since then, and acts until braking begins [N·m].

        Raises
        ------
        LimitError
        """
        if self._seen is None:
            return
        position, velocity = self._seen
        direction = 1.0 if velocity > 0.0 else -1.0
        # Only a torque in the direction of motion counts: a decrease of the speed is not confirmed by a sample.
        gained = direction * max(0.0, direction * accepted) / self._joint.inertia * age
        self._stops_inside(position + (velocity + 0.5 * gained) * age, velocity + gained, accepted)

    def _stops_inside(self, position: float, velocity: float, accepted: float) -> None:
        if self._braking is None or velocity == 0.0:
            return
        direction = 1.0 if velocity > 0.0 else -1.0
        pushed = max(0.0, direction * accepted) / self._joint.inertia
        speed = abs(velocity) + pushed * self._reaction
        stops = position + direction * self._way(speed)
        low, high = self._limits.position
        if low <= stops <= high:
            return
        raise LimitError(
            "position",
            f"at {position:.4f} rad and {velocity:.3f} rad/s, even immediate braking would stop the joint only at "
            f"{stops:.4f} rad, outside {low:.4f} to {high:.4f} rad",
            measured=stops,
            allowed=high if velocity > 0.0 else low,
        )

    def driven(self, position: float, velocity: float, accepted: float) -> None:
        """Check that the joint gains no energy while the commanded torque brakes it.

        Parameters
        ----------
        position, velocity : float
            [rad], [rad/s]
        accepted : float
            Torque that has acted since the previous sample [N·m].

        Raises
        ------
        LimitError
        """
        if self._place is not None:
            self._work += accepted * (position - self._place)
        self._place = position
        energy = self._joint.energy(position, velocity)
        self._watched.append((self._work, energy))
        work = self._work - self._watched[0][0]
        gained = energy - self._watched[0][1]
        doubt = (
            0.5 * self._joint.inertia * _NOTICED**2
            + _DOUBT * self._joint.weight * abs(velocity) * _WATCHED
        )
        self._against = self._against + 1 if work < -doubt and gained > doubt else 0
        if self._against >= self._often:
            raise LimitError(
                "torque_sign",
                f"in the last {1e3 * _WATCHED:.0f} ms the joint has gained {gained:.3g} J, although the commanded "
                f"torque took {-work:.3g} J from the joint: torque and position have opposite signs, or another "
                "force moves it",
                measured=gained,
                allowed=work,
            )

    def commanded(
        self, torque: float, position: float, velocity: float, acceleration: float
    ) -> None:
        """Check a command [N·m] against the largest torque that the reference needs.

        Raises
        ------
        LimitError
        """
        factor = self._limits.torque_envelope
        needed = self._joint.needed(position, velocity, acceleration)
        if factor is None or needed is None:
            return
        most = factor * needed + _SMALL * self._limits.torque
        self._beyond = self._beyond + 1 if abs(torque) > most else 0
        if self._beyond > self._longest:
            raise LimitError(
                "torque_envelope",
                f"{torque:.4g} N·m is commanded, but by the joint's parameters {needed:.4g} N·m is enough; the command "
                f"has been above {most:.4g} N·m for {self._beyond} cycles",
                measured=torque,
                allowed=most,
            )


def foresight_of(
    joint: MovingJoint | None, drive: Drive, limits: SessionLimits, options: SessionOptions
) -> Foresight | None:
    """Return the checks for a joint with known inertia; otherwise None."""
    if joint is None:
        return None
    return Foresight(limits, options.period, joint, drive.command_latency)
