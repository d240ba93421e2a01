"""Watches for an encoder that stands under a torque that must move the joint."""

from __future__ import annotations

import math

# That the joint must have moved by, of which the encoder showed one at most: 20 counts of a fine encoder, as many as
# this angle has of a coarser one, 4 at least.
_COUNTS, _ANGLE, _FEWEST = 20.0, math.radians(0.01), 4.0
_SEEN = 1.5  # counts: a count of jitter is none
_COARSE = 3.0  # counts a cycle, above which a speed is known


class EncoderWatch:
    """Says whether a joint, by its breakaway and inertia, must have moved and was not seen to.

    From the last change of the encoder on, the torque beyond the breakaway in its direction accelerates the
    inertia; what is less slows it down.

    Parameters
    ----------
    breakaway : tuple of float
        In the positive and in the negative direction [N·m].
    inertia : float
        [kg·m²]
    resolution : float
        Output angle of an encoder count [rad].
    """

    def __init__(self, breakaway: tuple[float, float], inertia: float, resolution: float) -> None:
        self._breakaway, self._inertia, self._resolution = breakaway, inertia, resolution
        self._unseen = max(_FEWEST * resolution, min(_COUNTS * resolution, _ANGLE))
        self._place, self._time = math.nan, math.nan
        self._direction = self._speed = self._way = 0.0

    def stands(self, time: float, position: float, torque: float) -> bool:
        """Take one more sample, and the torque since the one before [s], [rad], [N·m]; whether the encoder hangs."""
        step, self._time = time - self._time, time
        moved = position - self._place
        if not abs(moved) <= _SEEN * self._resolution:  # the first sample, too
            fast = abs(moved) > _COARSE * self._resolution and step > 0.0
            self._speed = (abs(moved) - _COARSE * self._resolution) / step if fast else 0.0
            self._place, self._direction, self._way = position, math.copysign(1.0, moved), 0.0
            return False
        direction = math.copysign(1.0, torque) if torque else self._direction
        if direction != self._direction:
            self._direction, self._speed, self._way = direction, 0.0, 0.0
        excess = abs(torque) - self._breakaway[direction < 0.0] if torque else -max(self._breakaway)
        before = self._speed
        self._speed = max(0.0, before + excess / self._inertia * step)
        self._way += 0.5 * (before + self._speed) * step
        return self._way > self._unseen
