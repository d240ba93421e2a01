"""Options of a session: its period, its way to the start, its velocity estimator."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields

from jointid.base.argument_checks import whole_number
from jointid.base.errors import InputError
from jointid.joint.checks import is_number

_MOST_COUNTS = 1_000_000


@dataclass(frozen=True, slots=True, kw_only=True)
class SessionOptions:
    """Options of a session.

    Attributes
    ----------
    period : float
        Between commands [s].
    approach_velocity : float
        Largest, on the way to the start [rad/s].
    settle : float
        Time at rest at the start [s].
    velocity_counts, velocity_time : int, float
        Of the velocity estimator (6.3.1): counts at least, [s] at most.
    resolution : float, optional
        Output angle of an encoder count [rad]. Default: the drive's own `resolution`.
    answer_timeout : float, optional
        For the drive's state in a cycle [s]; beyond, the position is stale. Default: three quarters of a
        period: after a late cycle the bus carries more frames.

    Raises
    ------
    InputError
        A value is of a wrong kind, or not within its range.
    """

    period: float = 2e-3
    approach_velocity: float = 0.3
    settle: float = 0.5
    velocity_counts: int = 5
    velocity_time: float = 0.01
    resolution: float | None = None
    answer_timeout: float | None = None

    def __post_init__(self) -> None:
        whole_number("velocity_counts", self.velocity_counts, 1, _MOST_COUNTS)
        for item in fields(self):
            value = getattr(self, item.name)
            if value is None and item.default is None:
                continue
            if not is_number(value):
                raise InputError("a number is expected", argument=item.name, value=value)
            if item.name == "settle":
                if not 0.0 <= value < math.inf:
                    raise InputError("at least 0 is expected", argument="settle", value=value)
            elif not 0.0 < value < math.inf:
                raise InputError("more than 0 is expected", argument=item.name, value=value)
