"""The plan from the samples so far: terms, bounds, windows, and the threshold of standstill."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from jointid import _core
from jointid.base.errors import InputError
from jointid.identification.search.domain import SearchDomain, domain_for
from jointid.online.settings import OnlineSettings
from jointid.problem.problem import Problem
from jointid.problem.terms import choose_terms
from jointid.recording.recording import Recording

# Range of the table of shapes, as a multiple of the largest speed so far.
_FASTER = 1.5
# Context before and after a piece, which shows whether the joint stands still at the piece's ends [s]; at
# most this share of the window.
_CONTEXT = 0.15
_LONGEST_CONTEXT = 0.1
# Ratios by which noise, speed or rate must change before a plan is replaced: when the window is full for
# the first time, and later.
_DIFFERS = 1.05
_CHANGED = 1.3
# Share of the planned travel: less travel is a pause, which does not define windows.
_RESTING = 0.01


@dataclass(slots=True, kw_only=True)
class Plan:
    """Settings for the processing of samples, computed from the samples in memory at one instant.

    Attributes
    ----------
    problem : Problem
    frame : Penalty
        Direct sum over the samples at that instant; it has the names of parameters and terms.
    domain : SearchDomain
    penalty : SlidingPenalty
        Penalty to which pieces are added.
    scale : MotionScale
        Scale of the whole motion, used to find slow motion.
    speed : float
        Largest speed that the table of shapes covers [rad/s or m/s].
    period : float
        Time between samples [s].
    duration : float
        Duration of an integration window [s].
    stretch : float
        Duration of a piece, a whole number of windows [s].
    context : float
        Duration of the context on each side of a piece [s].
    made : float
        Time of the plan, on the samples' clock [s].
    full : bool
        Whether a whole window of samples was in memory.
    """

    problem: Problem
    frame: _core.Penalty
    domain: SearchDomain
    penalty: _core.SlidingPenalty
    scale: _core.MotionScale
    speed: float
    period: float
    duration: float
    stretch: float
    context: float
    made: float
    full: bool


def make_plan(settings: OnlineSettings, recording: Recording, fastest: float) -> Plan | None:
    """Return a plan from the samples in memory; None if they are not sufficient yet.

    Parameters
    ----------
    settings : OnlineSettings
    recording : Recording
        The samples in memory.
    fastest : float
        Speed that the plan must cover [rad/s or m/s].

    Raises
    ------
    InputError
        The signals contradict the settings, or a whole window is not sufficient.
    """
    choice = choose_terms((recording,), settings.joint, settings.request)
    if choice.residual == "instruments":
        choice = replace(choice, residual="sensor")
    problem = settings.problem(recording, choice)
    core = problem.in_core[0]
    scale = _core.MotionScale(core)
    if not scale.moves or not problem.usable(0).any():
        return None
    full = recording.duration >= settings.window
    try:
        frame = problem.penalty(settings.windows)
        domain = domain_for(frame, settings.joint, settings.posed.parameters, problem.peak_speed)
    except InputError:
        if full:
            raise  # more samples of the same motion do not help
        return None
    duration = settings.windows
    if duration is None:
        duration = _wanted_duration(core, domain, settings)
    speed = _FASTER * max(problem.peak_speed, fastest)
    period = recording.sample_period
    penalty = _core.SlidingPenalty(
        terms=list(choice.terms),
        residual=_core.Residual[choice.residual],
        gear_ratio=choice.gear_ratio,
        window_duration=duration,
        mask_standstill=settings.posed.mask_standstill,
        scale=scale,
        lower=domain.lower,
        upper=domain.upper,
        speed=speed,
    )
    return Plan(
        problem=problem,
        frame=frame,
        domain=domain,
        penalty=penalty,
        scale=scale,
        speed=speed,
        period=period,
        duration=duration,
        # A whole number of windows, so that windows are as long as in one long recording.
        stretch=duration * math.ceil(settings.update / duration - 1e-6),
        context=max(
            _CONTEXT,
            4.0 * period,
            min(scale.memory + 4.0 * period, _LONGEST_CONTEXT * settings.window),
        ),
        made=float(recording.time[-1]),
        full=full,
    )


def outdated(plan: Plan, settings: OnlineSettings, recording: Recording) -> bool:
    """Return whether noise, speed or rate of the samples in memory require a new plan."""
    core = settings.problem(recording, plan.problem.choice).in_core[0]
    scale = _core.MotionScale(core)
    if not scale.moves or scale.travel < _RESTING * plan.scale.travel:
        return False
    first = not plan.full and recording.duration >= settings.window
    limit = _DIFFERS if first else _CHANGED
    pairs = [(scale.peak, plan.scale.peak), (recording.sample_period, plan.period)]
    if settings.windows is None:
        pairs.append((_wanted_duration(core, plan.domain, settings), plan.duration))
    return any(max(a, b) > limit * min(a, b) for a, b in pairs)


def _wanted_duration(
    core: _core.Recording, domain: SearchDomain, settings: OnlineSettings
) -> float:
    """Return the window duration for the velocity's noise; the frame's windows divide the recording evenly instead."""
    return _core.window_duration(core, len(domain.names), settings.posed.mask_standstill)
