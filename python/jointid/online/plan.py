"""What the samples seen so far decide: terms, bounds, windows, and what counts as standing still."""

from __future__ import annotations

import math
from dataclasses import dataclass

from jointid import _core
from jointid.base.errors import InputError
from jointid.identification.search.domain import SearchDomain, domain_for
from jointid.online.settings import Settings
from jointid.problem.problem import Problem
from jointid.problem.terms import choose_terms
from jointid.recording.recording import Recording

# Of the speed seen: room before the table of shapes has to be made anew.
_FASTER = 1.5
# Before and after a stretch, so that its ends know whether the joint stands still [s]; at the most, a
# share of the window.
_CONTEXT = 0.15
_LONGEST_CONTEXT = 0.1
# A plan is made anew when what it rests on has changed by these ratios: once when the window is full
# for the first time, and later.
_DIFFERS = 1.05
_CHANGED = 1.3
# Of the travel planned for: less is a pause, which tells nothing of windows.
_RESTING = 0.01


@dataclass(slots=True, kw_only=True)
class Plan:
    """How stretches are digested, and what follows from what was remembered when it was made.

    Attributes
    ----------
    scale : MotionScale
        What the whole motion makes of slow.
    speed : float
        The largest that the table of shapes serves.
    period : float
        Between samples [s].
    duration : float
        Of a window of integration [s].
    stretch : float
        Digested and forgotten at once: a whole number of windows [s].
    context : float
        Looked at on either side of a stretch [s].
    made : float
        On the samples' clock [s].
    full : bool
        Whether a whole window of samples was there.
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


def make_plan(settings: Settings, recording: Recording, fastest: float) -> Plan | None:
    """Terms, bounds and windows from what is there; None while it does not suffice.

    Raises
    ------
    InputError
        The signals cannot be what they are said to be, or a whole window does not suffice.
    """
    choice = choose_terms((recording,), settings.joint, settings.request)
    problem = settings.problem(recording, choice)
    core = problem.in_core[0]
    scale = _core.MotionScale(core)
    if not scale.moves or not _core.usable_intervals(core, settings.mask_standstill).any():
        return None
    full = recording.duration >= settings.window
    try:
        frame = problem.penalty(settings.windows)
        domain = domain_for(frame, settings.joint, settings.parameters, problem.peak_speed)
    except InputError:
        if full:
            raise  # more of the same will not mend it
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
        mask_standstill=settings.mask_standstill,
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
        # Windows that end with their stretch are as long as those of one long recording.
        stretch=duration * math.ceil(settings.update / duration - 1e-6),
        context=max(
            _CONTEXT,
            4.0 * period,
            min(scale.memory + 4.0 * period, _LONGEST_CONTEXT * settings.window),
        ),
        made=float(recording.time[-1]),
        full=full,
    )


def outdated(plan: Plan, settings: Settings, recording: Recording) -> bool:
    """Whether what is remembered by now asks for another plan: by noise, speed or rate."""
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


def _wanted_duration(core: _core.Recording, domain: SearchDomain, settings: Settings) -> float:
    """What the velocity's noise asks of a window; not the frame's, which divides the recording evenly."""
    return _core.window_duration(core, len(domain.names), settings.mask_standstill)
