"""Check that a drive's watchdog is quick enough for a motion: the joint's travel after the host's death is small."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from jointid import _core
from jointid.hardware.session.host_failure_travel import DeadHost
from jointid.hardware.session.limits import SessionLimits
from jointid.hardware.session.options import SessionOptions
from jointid.hardware.session.start_checks import approach_to
from jointid.hardware.session.watchdog import Watchdog, watchdog_of
from jointid.joint.joint import Joint
from jointid.simulation.arguments import Controller
from jointid.simulation.trajectory import Trajectory

_PERIODS = 2.5  # fewest periods in the watchdog's time, because a command may be late or lost
_ROUNDED = 1e-6  # share of a millisecond


@dataclass(frozen=True, slots=True, kw_only=True)
class WatchdogTravel:
    """Travel of a joint when its host dies in a motion, and the allowed travel.

    Attributes
    ----------
    watchdog : Watchdog
    travel : float
        Longest travel, from the worst moment of the motion [rad].
    at_once : float
        The same for a motor that goes off at once [rad].
    allowed : float
        Allowed travel [rad].
    stated : bool
        Whether `allowed` is from the joint file. Otherwise it is `at_once` plus a share of the position range.
    longest : float or None
        Longest watchdog time that passes, in whole ms [s]; None if `watchdog.time` passes, or if no time does.
    coasts : bool
        Whether the joint states no friction. `travel` then ends with the watchdog's time, and the joint coasts on.
    revolute : bool
        Whether the unit is rad; otherwise it is m.
    """

    watchdog: Watchdog
    travel: float
    at_once: float
    allowed: float
    stated: bool
    longest: float | None
    coasts: bool
    revolute: bool

    @property
    def passed(self) -> bool:
        """Whether the joint stays within the allowed travel."""
        return self.travel <= self.allowed

    def to_dict(self) -> dict[str, Any]:
        """Return the fields as JSON types."""
        watchdog = self.watchdog
        return {
            "time": watchdog.time,
            "fed_by": watchdog.fed_by,
            "then": watchdog.then,
            "read_back": watchdog.read_back,
            "travel": self.travel,
            "at_once": self.at_once,
            "allowed": self.allowed,
            "longest": self.longest,
            "coasts": self.coasts,
        }

    def __str__(self) -> str:
        return f"{self.watchdog}; {self._way()}"

    def problem(self) -> str:
        """Return the reason why the watchdog is too slow, with the longest time that passes."""
        if self.longest is None:
            remedy = "no watchdog time is short enough; move more slowly, or state another"
        else:
            remedy = (
                f"the longest acceptable time is {self.longest:g} s; set the drive to at most this time, or state "
                "another"
            )
        return (
            f"the drive's watchdog is too slow for this motion: {self}; {remedy} watchdog_travel under "
            "[session.limits]"
        )

    def _way(self) -> str:
        until = (
            " until the watchdog acts, and coasts on (no friction is stated)" if self.coasts else ""
        )
        source = (
            "stated as watchdog_travel"
            if self.stated
            else f"{self._angle(self.at_once)} if the motor is off at once, plus a share of the window"
        )
        return (
            f"the joint goes up to {self._angle(self.travel)} after the host's death{until}; "
            f"{self._angle(self.allowed)} is allowed ({source})"
        )

    def _angle(self, value: float) -> str:
        return f"{math.degrees(value):.4g}°" if self.revolute else f"{value:.4g} m"


def watchdog_travel(
    watchdog: Watchdog,
    joint: Joint | None,
    controller: Controller,
    trajectory: Trajectory,
    limits: SessionLimits,
    options: SessionOptions,
    *,
    position: float,
) -> WatchdogTravel:
    """Return how far a joint goes when its host dies in a session.

    Parameters
    ----------
    watchdog : Watchdog
        Watchdog of the drive.
    joint : Joint or None
        Its stated inertia, friction and weight are used.
    controller, trajectory, limits, options
        As in the session.
    position : float
        Position of the joint before the session [rad].
    """
    dead = DeadHost(joint, limits.torque)
    if isinstance(controller, _core.OpenLoop):
        worst = dead.worst_moments(dead.commanded(trajectory, options.period, position, limits))
    else:
        start = float(trajectory.sample(np.zeros(1))[0][0])
        approach = approach_to(start - position, options)
        worst = dead.worst_moments(
            dead.moments(trajectory, options.period),
            dead.moments(approach, options.period, offset=position),
        )
    at_once = dead.travel(worst, 0.0)
    stated = limits.watchdog_travel
    allowed = at_once + limits.watchdog_share if stated is None else stated
    milliseconds = math.ceil(1e3 * watchdog.time - _ROUNDED)
    travel = dead.travel(worst, 1e-3 * milliseconds)
    longest = None
    if travel > allowed >= at_once:
        passes = 0
        while milliseconds - passes > 1:
            between = (passes + milliseconds) // 2
            if dead.travel(worst, 1e-3 * between) > allowed:
                milliseconds = between
            else:
                passes = between
        longest = 1e-3 * passes if passes else None
    return WatchdogTravel(
        watchdog=watchdog,
        travel=travel,
        at_once=at_once,
        allowed=allowed,
        stated=stated is not None,
        longest=longest,
        coasts=dead.coasts,
        revolute=joint is None or joint.kind == "revolute",
    )


def watchdog_problems(travel: WatchdogTravel, options: SessionOptions) -> Iterator[str]:
    """Yield the reasons why a session must not start with a drive's watchdog.

    Parameters
    ----------
    travel : WatchdogTravel
    options : SessionOptions
    """
    watchdog = travel.watchdog
    if watchdog.then == "nothing":
        yield (
            f"the drive does nothing when the host is gone ({watchdog}), so the motor would go on; set the drive to "
            "switch its motor off"
        )
    elif watchdog.then != "off" and not options.acknowledge_damped:
        yield (
            f"when the host is gone, the drive does not switch its motor off; the motor is then {watchdog.then}; if "
            "you accept this state, set acknowledge_damped = true under [session]"
        )
    if options.period * _PERIODS > watchdog.time * (1.0 + 1e-9):
        yield (
            f"a period of {options.period:g} s is too long for a watchdog of {watchdog.time:g} s: at most "
            f"{watchdog.time / _PERIODS:g} s is expected"
        )
    if not travel.passed:
        yield travel.problem()


def slow_watchdog(
    drive: object,
    joint: Joint | None,
    controller: Controller,
    trajectory: Trajectory,
    limits: SessionLimits,
    options: SessionOptions,
    *,
    position: float,
) -> list[str]:
    """Return the reasons why a session must not start with the watchdog of its drive; empty without one."""
    watchdog = watchdog_of(drive)
    if watchdog is None:
        return []
    travel = watchdog_travel(
        watchdog, joint, controller, trajectory, limits, options, position=position
    )
    return [*watchdog_problems(travel, options)]
