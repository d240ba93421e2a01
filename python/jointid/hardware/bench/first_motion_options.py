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
    counts : int, optional
        Encoder counts that are a motion, beside `more_counts`. Default: 5; fewer where both together would be
        more than 0.1°, but 2 at least.
    more_counts : int, optional
        Counts that must follow while the torque is held; without them it was the gear winding up. Default: 10; fewer
        as of `counts`.
    growth_time : float
        In which the torque grows by a factor of e [s]: a constant share of the torque in each cycle, so that a
        weak joint is approached as carefully as a strong one. Default 2.
    travel : float, optional
        Farthest from the start, by the joint file's gear ratio [rad]; beyond, the motor goes off. Default: 0.4°, or 40
        encoder counts where that is more.
    velocity : float
        Highest speed [rad/s]; beyond, the motor goes off. Default 0.5.
    still_time : float
        That the joint must stand before it is moved, motor off and on [s]. Default 0.5.
    moves : tuple of float, optional
        Amplitudes of the small motions under control, each after the one before has succeeded [rad].
        Default: 0.1°, 0.2° and 0.3°, or a third, two thirds and all of 20 encoder counts where that is more.
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
