"""The refinements: delays first, since a late signal also looks like slow motion that disagrees."""

from __future__ import annotations

from collections.abc import Mapping

from jointid import _core
from jointid.base.advice import Action
from jointid.base.errors import InputError
from jointid.base.values import dataclass
from jointid.estimate.delays import Delay
from jointid.estimate.slow_motion import SlowMotion
from jointid.identification.refinements.delays import delays_removed, refined_delays
from jointid.identification.refinements.sensor_instant import SensorInstant
from jointid.identification.refinements.slow_motion import contradicting
from jointid.problem.problem import Problem
from jointid.problem.windows import Windows
from jointid.recording.mending import Mend


@dataclass(frozen=True, kw_only=True)
class Refinements:
    """What was found out about the data before the search, and done to them.

    Attributes
    ----------
    mends : tuple of tuple of Mend
        What was put right in each recording before all else.
    delays : mapping of str to Delay
    slow_motion : SlowMotion or None
    sensor_instant : SensorInstant or None
        When the sensor is sampled; None where there is no sensor, or no held torque.
    """

    mends: tuple[tuple[Mend, ...], ...]
    delays: Mapping[str, Delay]
    slow_motion: SlowMotion | None
    sensor_instant: SensorInstant | None = None


def without_delays(
    problem: Problem, shift: Mapping[str, float] | None, *, measure: bool = True
) -> tuple[Problem, dict[str, Delay]]:
    """Return the problem without its signals' delays, and these by signal.

    Parameters
    ----------
    shift : mapping of str to float or None
        [s]; None: chosen.
    measure : bool
        Whether the delays that `shift` leaves are measured, too. Default True.

    Raises
    ------
    InputError
        A shift that these recordings cannot have.
    """
    if not measure:
        return delays_removed(problem, shift or {}), {}
    return refined_delays(problem, shift)


def without_creep(
    problem: Problem, windows: Windows, min_speed: float | None
) -> tuple[Problem, _core.Penalty, SlowMotion | None]:
    """Return the problem without slow motion that contradicts, its penalty, and that slow motion.

    Parameters
    ----------
    min_speed : float or None
        [rad/s or m/s]; None: chosen.

    Raises
    ------
    InputError
        Windows that cannot be cut; a minimum speed that leaves too little motion.
    """
    if min_speed:
        problem = _faster(problem, windows, min_speed)
    penalty = problem.penalty(windows)
    if min_speed is not None:
        return problem, penalty, None
    slow = contradicting(problem, penalty)
    if slow is not None:
        problem = problem.changed(min_speed=slow.speed)
        penalty = problem.penalty(windows)
    return problem, penalty, slow


def _faster(problem: Problem, windows: Windows, min_speed: float) -> Problem:
    """The problem without motion that is slower; an error tells what the speed leaves."""
    faster = problem.changed(min_speed=min_speed)
    try:
        faster.parts(windows)
    except InputError as error:
        problem.parts(windows)  # raises where the speed is not to blame
        unit = "rad/s" if problem.recordings[0].kind == "revolute" else "m/s"
        raise InputError(
            f"it leaves too little motion: the joint moves at up to {problem.peak_speed:.3g} {unit}",
            argument="min_speed",
            value=min_speed,
            remedy=Action("call", {"min_speed": 0}),
        ) from error
    return faster
