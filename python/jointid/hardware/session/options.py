"""How a session goes: its period, its way to the start, its velocity estimator."""

from __future__ import annotations

import math
from dataclasses import dataclass

from jointid.base.errors import InputError


@dataclass(frozen=True, slots=True, kw_only=True)
class SessionOptions:
    """How a session goes.

    Attributes
    ----------
    period : float
        Between commands [s].
    approach_velocity : float
        Largest, on the way to the start [rad/s].
    settle : float
        Time of standing at the start [s].
    velocity_counts, velocity_time : int, float
        Of the velocity estimator (6.3.1): counts at least, [s] at most.
    resolution : float
        Output angle of an encoder count [rad].
    answer_timeout : float, optional
        For the drive's state in a cycle [s]; beyond, the position is stale. Default: three quarters of a
        period: behind a late cycle the bus is fuller.
    """

    period: float = 2e-3
    approach_velocity: float = 0.3
    settle: float = 0.5
    velocity_counts: int = 5
    velocity_time: float = 0.01
    resolution: float = 2.0 * math.pi / 808_000
    answer_timeout: float | None = None

    def __post_init__(self) -> None:
        for name in ("period", "approach_velocity", "velocity_time", "resolution"):
            value = getattr(self, name)
            if not 0.0 < value < math.inf:
                raise InputError(f"SessionOptions: {name} is {value!r}; more than 0 is expected")
        if not 0.0 <= self.settle < math.inf:
            raise InputError(f"SessionOptions: settle is {self.settle!r}; at least 0 is expected")
        if self.answer_timeout is not None and not 0.0 < self.answer_timeout < math.inf:
            raise InputError(
                f"SessionOptions: answer_timeout is {self.answer_timeout!r}; more than 0 is expected"
            )
