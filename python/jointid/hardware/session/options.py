"""Options of a session: its period, its motion to the start, its velocity estimator."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields, replace

from jointid.base.argument_checks import whole_number
from jointid.base.errors import InputError
from jointid.joint.checks import is_number

_MOST_COUNTS = 1_000_000

# Each cycle of a session is kept in memory until its end, in some 300 bytes. This number of cycles needs 1.5 GB:
# 83 minutes at 1 kHz, and almost three hours at the default period.
MOST_CYCLES = 5_000_000
SHORTEST_PERIOD = 1e-5  # s; no bus and no drive keeps a shorter one
SLOWEST_APPROACH = 1e-4  # rad/s; a revolution takes almost a day


@dataclass(frozen=True, slots=True, kw_only=True)
class SessionOptions:
    """Options of a session.

    Attributes
    ----------
    period : float
        Time between commands [s]; at least 1e-5.
    approach_velocity : float
        Largest speed of the move to the start [rad/s]; at least 1e-4.
    settle : float
        Time at rest at the start [s]; at most 5 million periods.
    velocity_counts : int
        Number of encoder counts between two velocity estimates (thesis, 6.3.1).
    velocity_time : float
        Longest time between two velocity estimates [s].
    resolution : float, optional
        Output angle of one encoder count [rad]. Default: the drive's own `resolution`.
    answer_timeout : float, optional
        Longest wait for the drive's state in a cycle [s]. After this time, the position is stale. Default: three
        quarters of a period.
    acknowledge_damped : bool
        Whether to start with a drive that does not switch its motor off when the host fails, but damps, holds or
        brakes it.

    Raises
    ------
    InputError
        A value has the wrong type or is outside its range.
    """

    period: float = 2e-3
    approach_velocity: float = 0.3
    settle: float = 0.5
    velocity_counts: int = 5
    velocity_time: float = 0.01
    resolution: float | None = None
    answer_timeout: float | None = None
    acknowledge_damped: bool = False

    def __post_init__(self) -> None:
        whole_number("velocity_counts", self.velocity_counts, 1, _MOST_COUNTS)
        if not isinstance(self.acknowledge_damped, bool):
            raise InputError(
                "true or false is expected",
                argument="acknowledge_damped",
                value=self.acknowledge_damped,
            )
        for item in fields(self):
            value = getattr(self, item.name)
            if item.name == "acknowledge_damped" or (value is None and item.default is None):
                continue
            if not is_number(value):
                raise InputError("a number is expected", argument=item.name, value=value)
            if item.name == "settle":
                if not 0.0 <= value < math.inf:
                    raise InputError("at least 0 is expected", argument="settle", value=value)
            elif not 0.0 < value < math.inf:
                raise InputError("more than 0 is expected", argument=item.name, value=value)
        for name, least, unit in (
            ("period", SHORTEST_PERIOD, "s"),
            ("approach_velocity", SLOWEST_APPROACH, "rad/s"),
        ):
            value = getattr(self, name)
            if value < least:
                raise InputError(
                    f"at least {least:g} {unit} is expected", argument=name, value=value
                )
        check_cycles("settle", self.settle, self.period)

    @property
    def timeout(self) -> float:
        """Longest wait for an answer in a cycle [s]."""
        return 0.75 * self.period if self.answer_timeout is None else self.answer_timeout


def check_cycles(name: str, time: float, period: float) -> None:
    """Check that a time [s] has no more cycles than a session can keep.

    Raises
    ------
    InputError
        The time is too long; the message names the longest time for this period.
    """
    if time > MOST_CYCLES * period:
        raise InputError(
            f"at most {MOST_CYCLES * period:g} s ({MOST_CYCLES} cycles) is expected with a "
            f"period of {period:g} s",
            argument=name,
            value=time,
        )


def with_resolution(options: SessionOptions, drive: object) -> SessionOptions:
    """Return options with a known resolution: their own, or the drive's.

    Raises
    ------
    InputError
        Neither resolution is known.
    """
    if options.resolution is not None:
        return options
    resolution = getattr(drive, "resolution", None)
    if resolution is None:
        raise InputError(
            "not known: neither the session's options nor the drive states the output angle per encoder count",
            argument="resolution",
        )
    return replace(options, resolution=float(resolution))
