"""Corrections of the data. Delays come first, because a late signal also looks like contradicting slow motion."""

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
from jointid.recording.corrections import Mend


@dataclass(frozen=True, kw_only=True)
class Refinements:
    """Results and corrections of the data before the search.

    Attributes
    ----------
    mends : tuple of tuple of Mend
        Repairs of each recording, made first.
    delays : mapping of str to Delay
    slow_motion : SlowMotion or None
    sensor_instant : SensorInstant or None
        Sampling instant of the sensor; None without a sensor or without a held torque.
    """

    mends: tuple[tuple[Mend, ...], ...]
    delays: Mapping[str, Delay]
    slow_motion: SlowMotion | None
    sensor_instant: SensorInstant | None = None


def without_delays(
    problem: Problem, shift: Mapping[str, float] | None, *, measure: bool = True
) -> tuple[Problem, dict[str, Delay]]:
    """Return the problem without the delays of its signals, and the delays by signal.

    Parameters
    ----------
    shift : mapping of str to float or None
        Delays to remove [s]; None: chosen from the data.
    measure : bool
        Whether to estimate the delays that remain after `shift`. Default True.

    Raises
    ------
    InputError
        A shift that is impossible for these recordings.
    """
    if not measure:
        return delays_removed(problem, shift or {}), {}
    return refined_delays(problem, shift)


def without_creep(
    problem: Problem, windows: Windows, min_speed: float | None
) -> tuple[Problem, _core.Penalty, SlowMotion | None]:
    """Return the problem without contradicting slow motion, its penalty, and that slow motion.

    Parameters
    ----------
    min_speed : float or None
        Minimum speed [rad/s or m/s]; None: chosen from the data.

    Raises
    ------
    InputError
        Windows that are invalid for these recordings, or a minimum speed that leaves too little motion.
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
    """Return the problem without motion slower than `min_speed`; raise an error if too little motion remains."""
    faster = problem.changed(min_speed=min_speed)
    try:
        faster.parts(windows)
    except InputError as error:
        problem.parts(windows)  # raises if the minimum speed is not the cause
        unit = "rad/s" if problem.recordings[0].kind == "revolute" else "m/s"
        raise InputError(
            "the recording has too little motion above this speed; the joint's top speed is "
            f"{problem.peak_speed:.3g} {unit}",
            argument="min_speed",
            value=min_speed,
            remedy=Action("call", {"min_speed": 0}),
        ) from error
    return faster
