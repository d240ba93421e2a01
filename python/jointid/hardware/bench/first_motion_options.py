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
        Largest torque [N·m], by the joint file's constants. Default: five times the breakaway torque of the joint file,
        or twice without a torque sensor to watch, but at most the session's torque limit. Required if the joint file
        has no breakaway torque and no sensor is watched.
    compare_friction : bool
        Whether to compare the measured breakaway torque with the joint file's friction, within a factor of 1.5.
        Use False if the file's values are guesses. Default True.
    watch_sensor : bool
        Whether a change of the torque sensor's reading ends the search for motion while the encoder stands still.
        Default True.
    hand_turn : float, optional
        Longest wait, motor off, until the joint is turned by hand and the encoder counts [s]. Default: no wait; without
        a sensor to watch, a stuck encoder then shows only at the largest torque.
    counts : int, optional
        Encoder counts that show a motion, together with `more_counts`. Default: 5, or fewer if both together exceed
        0.1°, but at least 2.
    more_counts : int, optional
        Counts that must follow while the torque is constant; without them the gear only winds up. Default: 10, or
        fewer as for `counts`.
    growth_time : float
        Time in which the torque grows by a factor of e [s], so that the search is equally careful on weak and strong
        joints. Default 2.
    travel : float, optional
        Largest distance from the start, by the joint file's gear ratio [rad]; beyond it the motor goes off. Default:
        0.4° or 40 encoder counts, whichever is larger.
    velocity : float
        Highest speed [rad/s]; beyond it the motor goes off. Default 0.5.
    still_time : float
        Time at rest before a motion, with the motor off and on [s]. Default 0.5.
    moves : tuple of float, optional
        Amplitudes of the small controlled motions, in order [rad]. Default: 0.1°, 0.2° and 0.3°, or 1/3, 2/3 and all
        of 20 encoder counts if that is more.
    longest : float
        Longest time with the motor on [s]. Default 55.

    Raises
    ------
    InputError
        A value of the wrong kind or outside its range.
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
