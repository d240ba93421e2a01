"""Watch for an encoder that shows no motion under a torque that must move the joint."""

from __future__ import annotations

import math

# Motion that must be seen, while the encoder shows at most one count: 20 counts of a fine encoder; for a coarser one
# the counts of this angle, at least 4.
_COUNTS, _ANGLE, _FEWEST = 20.0, math.radians(0.01), 4.0
_SEEN = 1.5  # counts; one count may be jitter
_COARSE = 3.0  # counts per cycle, above which a speed is known


class EncoderWatch:
    """Watch that compares the encoder with the motion expected from breakaway and inertia.

    From the last change of the encoder on, the torque above the breakaway accelerates the inertia. A smaller torque
    slows it down.

    Parameters
    ----------
    breakaway : tuple of float
        Breakaway in the positive and the negative direction [N·m].
    inertia : float
        Inertia at the output [kg·m²].
    resolution : float
        Output angle of an encoder count [rad].
    """

    def __init__(self, breakaway: tuple[float, float], inertia: float, resolution: float) -> None:
        self._breakaway, self._inertia, self._resolution = breakaway, inertia, resolution
        self._unseen = max(_FEWEST * resolution, min(_COUNTS * resolution, _ANGLE))
        self._place, self._time = math.nan, math.nan
        self._direction = self._speed = self._way = 0.0

    def stands(self, time: float, position: float, torque: float) -> bool:
        """Take a sample [s], [rad] and the torque since the previous one [N·m]. Return whether the encoder hangs."""
        step, self._time = time - self._time, time
        moved = position - self._place
        if not abs(moved) <= _SEEN * self._resolution:  # also for the first sample
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
