"""The refinements in order: delays first, since a late signal also looks like slow motion that disagrees."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

from jointid import _core
from jointid.estimate.delays import Delay
from jointid.estimate.slow_motion import SlowMotion
from jointid.identification.refinements.delays import refined_delays
from jointid.identification.refinements.slow_motion import checked_speed, contradicting
from jointid.problem.problem import Problem
from jointid.problem.windows import Windows
from jointid.recording.shifting import checked_shift


@dataclass(frozen=True, kw_only=True)
class Refinements:
    """What was found out about the data before the search, and done to them.

    Attributes
    ----------
    delays : mapping of str to Delay
    slow_motion : SlowMotion or None
    """

    delays: Mapping[str, Delay]
    slow_motion: SlowMotion | None


def refined(
    problem: Problem,
    windows: Windows,
    *,
    shift: Mapping[str, float] | None,
    min_speed: float | None,
) -> tuple[Problem, _core.Penalty, Refinements]:
    """Return the problem with shifted signals and without contradicting slow motion, its penalty, and what was found.

    Parameters
    ----------
    shift : mapping of str to float or None
        [s]; None: chosen.
    min_speed : float or None
        [rad/s or m/s]; None: chosen.

    Raises
    ------
    InputError
        A shift or a speed that cannot be used, or windows that cannot be cut.
    """
    given = None if shift is None else checked_shift(shift)
    speed = checked_speed(min_speed)
    problem, delays = refined_delays(problem, given)
    if speed:
        problem = replace(problem, min_speed=speed)
    penalty = problem.penalty(windows)
    slow = None
    if speed is None:
        slow = contradicting(problem, penalty)
        if slow is not None:
            problem = replace(problem, min_speed=slow.speed)
            penalty = problem.penalty(windows)
    return problem, penalty, Refinements(delays=delays, slow_motion=slow)
