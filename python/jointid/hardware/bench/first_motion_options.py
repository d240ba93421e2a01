"""Options of a first motion: its speed, its distance, and its largest torque."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields

from jointid.base.errors import InputError
from jointid.joint.checks import is_number

_MOST_COUNTS = 10_000


@dataclass(frozen=True, slots=True, kw_only=True)
class FirstMotionOptions:
    """Options of a first motion, from the table `[session.first_motion]`.

    Attributes
    ----------
    largest_torque : float, optional
        Largest torque before the joint moves [N·m], computed with the joint file's constants. Default: five times the
        breakaway torque in the joint file, or twice this torque without a watched torque sensor. The session's torque
        limit also applies. This key is required without a breakaway torque and without a watched sensor.
    compare_friction : bool
        Whether to compare the measured breakaway torque with the joint file's friction. The stated friction must then
        be correct within a factor of 1.5. Set false if the stated friction is only a guess. Default true.
    watch_sensor : bool
        Whether to stop if the torque sensor's reading changes while the encoder count is constant. Set false for a
        sensor that shows the motor's torque. Default true.
    hand_turn : float, optional
        Longest wait with the motor off, until somebody turns the joint by hand by 50 counts [s]. Default: no wait.
        Without a watched sensor, an encoder that does not count is then found only at the largest torque.
    counts : int, optional
        Number of encoder counts that show a motion. Default: 5, or fewer (at least 2) if `counts` and `more_counts`
        would exceed 0.1° together.
    more_counts : int, optional
        Number of further counts that must follow while the torque is held. Without these counts, the gear has only
        wound up. Default: 10, or fewer (at least 2) under the same condition as for `counts`.
    growth_time : float
        Time in which the torque grows by a factor of e [s]. Exponential growth is equally careful for joints with
        small and large breakaway torque. Default 2.
    travel : float, optional
        Largest distance from the start [rad], computed with the joint file's gear ratio. Beyond this distance, the
        motor is switched off. Default: the larger of 0.4° and 40 encoder counts.
    velocity : float
        Highest speed [rad/s]. Above this speed, the motor is switched off. Default 0.5.
    still_time : float
        Time at rest before the motion [s], first with the motor off, then again with the motor on. Default 0.5.
    moves : tuple of float, optional
        Amplitudes of the small controlled motions, in order [rad]. Default: 0.1°, 0.2° and 0.3°. If 20 encoder counts
        exceed 0.3°: a third, two thirds and all of 20 counts.
    longest : float
        Longest time with the motor on [s]. Default 55.

    Raises
    ------
    InputError
        A value has the wrong type or is outside its range.
    """

    largest_torque: float | None = None
    compare_friction: bool = True
    watch_sensor: bool = True
    hand_turn: float | None = None
    counts: int | None = None
    more_counts: int | None = None
    growth_time: float = 2.0
    travel: float | None = None
    velocity: float = 0.5
    still_time: float = 0.5
    moves: tuple[float, ...] | None = None
    longest: float = 55.0

    def __post_init__(self) -> None:
        for item in fields(self):
            value = getattr(self, item.name)
            if item.name in ("compare_friction", "watch_sensor", "moves") or (
                value is None and item.default is None
            ):
                continue
            if not is_number(value) or not 0.0 < value < math.inf:
                raise InputError("more than 0 is expected", argument=item.name, value=value)
        for name in ("compare_friction", "watch_sensor"):
            if not isinstance(getattr(self, name), bool):
                raise InputError(
                    "true or false is expected", argument=name, value=getattr(self, name)
                )
        for name in ("counts", "more_counts"):
            value = getattr(self, name)
            if value is not None and not (isinstance(value, int) and 2 <= value <= _MOST_COUNTS):
                raise InputError(f"2 to {_MOST_COUNTS} is expected", argument=name, value=value)
        if not all(is_number(move) and 0.0 < move < math.inf for move in self.moves or ()):
            raise InputError(
                "amplitudes of more than 0 are expected",
                argument="moves",
                value=self.moves,
            )
