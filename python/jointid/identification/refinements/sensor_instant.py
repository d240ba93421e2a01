"""When a torque sensor is sampled: before a held command steps, in its middle, or after it.

A held torque steps at the samples, and with it the acceleration of drive and link together. The link's share of that
is a step in the sensor's reading. A controller reads before it commands, so its samples lack half of the step that a
reading in the middle would show; integrated over windows that biases the gain, and what it leaves resembles late
signals, harmonics and friction at low speed.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.balance.least_squares import solve
from jointid.base.values import dataclass
from jointid.problem.problem import Problem
from jointid.problem.windows import Windows
from jointid.recording.recording import Recording

Array = NDArray[np.float64]

_SURE = 3.0  # standard errors
_KNOWN = 0.3  # standard error of a share that is worth taking away
_LEAST = 0.25  # standard error: the friction, too, changes within a sample
_LOG_ODDS = 3.0  # of one instant against another, where neither is measured sharply: 20 to 1
_FEWEST = 50  # windows
_RESTING = 1e-3  # share of the samples
_MOVING = 0.02  # of the peak speed


@dataclass(frozen=True, slots=True, kw_only=True)
class SensorInstant:
    """When the sensor is sampled, against the steps of a held torque.

    Attributes
    ----------
    share : float
        1: before the step; 0: in its middle, or where the reading is smooth; -1: after it.
    stderr : float
    applied : float
        What was taken away.
    """

    share: float
    stderr: float
    applied: float

    @property
    def unknown(self) -> float:
        """Standard error of what is left, as a part of half a step; 1 where nothing is known."""
        if self.stderr > _KNOWN and not self.applied:
            return 1.0
        return min(1.0, float(np.hypot(self.share - self.applied, max(self.stderr, _LEAST))))


def without_early_reading(
    problem: Problem, penalty: _core.Penalty, windows: Windows
) -> tuple[Problem, _core.Penalty, SensorInstant | None]:
    """Return problem and penalty with the reading in the middle of the torque's steps, where that is certain.

    Parameters
    ----------
    problem : Problem
    penalty : Penalty
        Over `windows`.
    windows : int, float, str, WindowOptions or None

    Notes
    -----
    The link's equation has no friction: its reading is inertia, gravity and an offset, and the torque's steps are
    regressed beside them. What a full half step is follows from the inertia that the reading shows and from that
    which the torque shows, so it needs no known inertia.
    """
    held = [problem.hold(number) == "zoh" for number in range(len(problem.recordings))]
    late = {"sensor", "torque"} & set(problem.shift)
    if not problem.choice.sensor or not any(held) or late or penalty.window_count < _FEWEST:
        return problem, penalty, None
    if any(map(_rests_on_a_limit, problem.recordings)):
        return problem, penalty, None
    found = _measured(problem, penalty, held)
    if found is None:
        return problem, penalty, None
    instant, step = found
    if not instant.applied:
        return problem, penalty, instant
    moved = tuple(
        _with_step(problem, number, instant.applied * step) if held[number] else run
        for number, run in enumerate(problem.recordings)
    )
    problem = replace(problem, recordings=moved)
    return problem, problem.penalty(windows), instant


def _measured(
    problem: Problem, penalty: _core.Penalty, held: list[bool]
) -> tuple[SensorInstant, float] | None:
    """The instant, and what half a step of 1 N·m changes the reading by."""
    integrals = _integrals(problem, penalty, held)
    rows = np.asarray(_core.triangle(integrals))
    torque, reading = integrals.shape[1] - 2, integrals.shape[1] - 1
    if not (rows[:, 0].any() and rows[:, _STEPS].any()):
        return None
    link = [*range(_STEPS + 1)]
    drive = [index for index in range(torque) if index != _STEPS]
    both = float(solve(rows, drive, torque)[0][0])
    of_reading, missed = solve(rows, link, reading)
    half = 0.5 * float(of_reading[0]) / both if both > 0.0 else 0.0
    if half == 0.0:
        return None
    _, alone = solve(rows, link[:_STEPS], _STEPS)  # what of the steps nothing else is like
    # A reading that lacks half a step over its window rises by less.
    share = -float(of_reading[_STEPS]) / half
    noise = missed / math.sqrt(max(1, len(integrals) - len(link)))
    stderr = noise / alone / abs(half) if alone > 0.0 else math.inf
    if not _settled(share, stderr) and "velocity" not in problem.shift:
        from jointid.identification.refinements.instant_by_samples import by_samples

        finer = by_samples(problem, half)
        if finer is not None and finer[1] < stderr:
            return _by_odds(*finer), half
    least = _SURE * max(stderr, _LEAST)
    certain = _settled(share, stderr)
    # A controller reads just before it commands: that, unless it is refuted.
    whole = abs(share) + least > 1.0
    applied = (float(np.sign(share)) if whole else share) if certain else 0.0
    return SensorInstant(share=share, stderr=stderr, applied=applied), half


def _by_odds(share: float, stderr: float) -> SensorInstant:
    """Before the step, if that is likelier by far than in its middle, and not refuted."""
    odds = (2.0 * share - 1.0) / (2.0 * stderr**2)
    before = odds > _LOG_ODDS and share < 1.0 + _SURE * max(stderr, _LEAST)
    return SensorInstant(share=share, stderr=stderr, applied=float(before))


def _settled(share: float, stderr: float) -> bool:
    """Whether a share is certain, and one that a reading can lack."""
    return stderr < _KNOWN and _SURE * stderr < abs(share) < 1.0 + _SURE * max(stderr, _LEAST)


_STEPS = 4  # column of the torque's steps


def _integrals(problem: Problem, penalty: _core.Penalty, held: list[bool]) -> Array:
    """Window integrals, a column each: of the link's motion, the torque's steps and friction; the torque; the reading.

    Angle and speed are those of each window's middle, because all but the reading and the steps is smooth enough.
    """
    periods = [
        recording.sample_period if held[number] else 0.0
        for number, recording in enumerate(problem.recordings)
    ]
    slow = 0.1 * problem.peak_speed
    moved = penalty.link_motion(*problem.masked, periods, slow)
    rows, duration, lasting = moved[:, :-1], moved[:, 3], moved[:, -1]
    whole = np.abs(lasting - duration) < 1e-9 * lasting + 1e-12
    return rows if whole.all() else np.compress(whole, rows.T, axis=1).T  # still by columns


def _rests_on_a_limit(recording: Recording) -> bool:
    """Whether the reading may be clipped: what it lacks there is no half step."""
    reading, speed = np.asarray(recording.sensor), np.abs(recording.velocity)
    fastest = max(map(abs, recording.ranges["velocity"]))
    moving = speed > _MOVING * fastest  # at rest a clean reading stays, too
    most = _RESTING * np.count_nonzero(moving)
    for limit in recording.ranges["sensor"]:
        there = reading == limit
        # First all of them, which is a single count.
        if np.count_nonzero(there) > most and np.count_nonzero(there & moving) > most:
            return True
    return False


def _with_step(problem: Problem, number: int, step: float) -> Recording:
    """A recording with so much of each step of the torque added to its reading."""
    recording, torque = problem.recordings[number], problem.output_torque(number)
    usable = problem.usable(number)
    # Where friction is set-valued, it answers the step.
    used = np.append(usable, 0) | np.append(0, usable)
    change = np.diff(torque, prepend=torque[0]) * (used > 0)
    change[[gap.index + 1 for gap in recording.gaps]] = 0.0
    return recording.with_signals(sensor=recording.sensor + step * change)
