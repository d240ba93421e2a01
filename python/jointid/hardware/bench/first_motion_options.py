"""Options of a first motion: how slowly, how far, and with how much torque at most."""

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
        The cap, by the joint file's constants [N·m]: without motion, the torque ends there. Default: five
        times the breakaway that the joint file states, twice where there is no torque sensor to watch, and never more
        than the session's torque limit. Required where there is neither a stated breakaway nor a sensor to watch.
    compare_friction : bool
        The joint file states the joint's friction within a factor of 1.5, and the measured breakaway is held
        against it. False where its values are only guesses. Default True.
    watch_sensor : bool
        A torque sensor that leaves its reading at rest while the encoder stands ends the search for motion.
        Default True.
    hand_turn : float, optional
        Time to wait, motor off, until somebody has turned the joint by hand and the encoder has counted [s]. Default:
        nobody is awaited; without a sensor to watch, an encoder that hangs then shows only at the cap.
    counts : int
        Encoder counts that are a motion, beside `more_counts`. Default 5.
    more_counts : int
        Counts that must follow while the torque is held; else it was the gear winding up. Default 10.
    growth_time : float
        In which the torque grows by a factor of e [s]: a constant share of the torque in each cycle, so that a
        weak joint is approached as carefully as a strong one. Default 2.
    travel : float
        Farthest from the start, by the joint file's gear ratio [rad]; beyond, the motor goes off. Default 0.4°.
    velocity : float
        Highest speed [rad/s]; beyond, the motor goes off. Default 0.5.
    still_time : float
        That the joint must stand before it is moved, motor off and on [s]. Default 0.5.
    moves : tuple of float
        Amplitudes of the small motions under control, each after the one before has succeeded [rad].
        Default 0.1°, 0.2° and 0.3°.
    longest : float
        Time that the motor may be on [s]. Default 55.

    Raises
    ------
    InputError
        A value is of a wrong kind, or not within its range.
    """

    largest_torque: float | None = None
    compare_friction: bool = True
    watch_sensor: bool = True
    hand_turn: float | None = None
    counts: int = 5
    more_counts: int = 10
    growth_time: float = 2.0
    travel: float = math.radians(0.4)
    velocity: float = 0.5
    still_time: float = 0.5
    moves: tuple[float, ...] = (math.radians(0.1), math.radians(0.2), math.radians(0.3))
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
            if not (
                isinstance(getattr(self, name), int) and 2 <= getattr(self, name) <= _MOST_COUNTS
            ):
                raise InputError(
                    f"2 to {_MOST_COUNTS} is expected", argument=name, value=getattr(self, name)
                )
        if not all(is_number(move) and 0.0 < move <= self.travel for move in self.moves):
            raise InputError(
                f"amplitudes of more than 0 and at most travel, {self.travel:.4g} rad, are expected",
                argument="moves",
                value=self.moves,
            )
