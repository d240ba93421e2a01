"""Sampling instant of a torque sensor: before the step of a held command, in its middle, or after it.

A held torque steps at the samples, and the acceleration of drive and link steps with it. The link's share is a step in
the sensor reading. A controller reads the sensor before it sends the command. Its samples therefore lack half of the
step, compared with a reading in the middle. Integrated over windows, this biases the gain. The residual looks like late
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
_KNOWN = 0.3  # largest standard error of a share that is corrected
_LEAST = 0.25  # smallest standard error, because friction also changes within a sample
_LOG_ODDS = 3.0  # log odds between two instants if neither is measured precisely: 20 to 1
_FEWEST = 50  # windows
_RESTING = 1e-3  # share of the samples
_MOVING = 0.02  # share of the peak speed


@dataclass(frozen=True, slots=True, kw_only=True)
class SensorInstant:
    """Sampling instant of the sensor relative to the steps of a held torque.

    Attributes
    ----------
    share : float
        1: before the step; 0: in its middle, or with a smooth reading; -1: after it.
    stderr : float
        Standard error of the share.
    applied : float
        Share that was corrected.
    """

    share: float
    stderr: float
    applied: float

    @property
    def unknown(self) -> float:
        """Standard error of the remaining share of half a step; 1 if nothing is known."""
        if self.stderr > _KNOWN and not self.applied:
            return 1.0
        return min(1.0, float(np.hypot(self.share - self.applied, max(self.stderr, _LEAST))))


def without_early_reading(
    problem: Problem, penalty: _core.Penalty, windows: Windows
) -> tuple[Problem, _core.Penalty, SensorInstant | None]:
    """Return problem and penalty with the reading moved to the middle of the torque's steps, if that is certain.

    Parameters
    ----------
    problem : Problem
    penalty : Penalty
        Penalty over `windows`.
    windows : int, float, str, WindowOptions or None

    Notes
    -----
    The link's equation has no friction: the reading is the sum of inertia, gravity and an offset. The torque's steps
    are an additional regressor. The size of half a step follows from two estimated inertias, one from the reading
    and one from the torque. It needs no known inertia.
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
    """Return the instant, and the change of the reading by half a step of 1 N·m."""
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
    _, alone = solve(rows, link[:_STEPS], _STEPS)  # the part of the steps that is independent
    # A reading that lacks half a step rises less over its window.
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
    # A controller reads just before its command. This is assumed unless the data reject it.
    whole = abs(share) + least > 1.0
    applied = (float(np.sign(share)) if whole else share) if certain else 0.0
    return SensorInstant(share=share, stderr=stderr, applied=applied), half


def _by_odds(share: float, stderr: float) -> SensorInstant:
    """Return "before the step" if the data clearly prefer it to the middle of the step and do not reject it."""
    odds = (2.0 * share - 1.0) / (2.0 * stderr**2)
    before = odds > _LOG_ODDS and share < 1.0 + _SURE * max(stderr, _LEAST)
    return SensorInstant(share=share, stderr=stderr, applied=float(before))


def _settled(share: float, stderr: float) -> bool:
    """Return whether a share is certain and possible for a reading."""
    return stderr < _KNOWN and _SURE * stderr < abs(share) < 1.0 + _SURE * max(stderr, _LEAST)


_STEPS = 4  # column of the torque's steps


def _integrals(problem: Problem, penalty: _core.Penalty, held: list[bool]) -> Array:
    """Return window integrals, one column each: link motion, torque steps, friction, torque and reading.

    Angle and speed are those of each window's middle, because all signals except reading and steps are smooth enough.
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
    """Return whether the reading may be saturated. The part it then lacks is not half a step."""
    reading, speed = np.asarray(recording.sensor), np.abs(recording.velocity)
    fastest = max(map(abs, recording.ranges["velocity"]))
    moving = speed > _MOVING * fastest  # at rest, a clean reading is also constant
    most = _RESTING * np.count_nonzero(moving)
    for limit in recording.ranges["sensor"]:
        there = reading == limit
        # The first count is cheap and usually decides.
        if np.count_nonzero(there) > most and np.count_nonzero(there & moving) > most:
            return True
    return False


def _with_step(problem: Problem, number: int, step: float) -> Recording:
    """Return a recording with `step` times each torque step added to its reading."""
    recording, torque = problem.recordings[number], problem.output_torque(number)
    usable = problem.usable(number)
    # At standstill, friction responds to the step.
    used = np.append(usable, 0) | np.append(0, usable)
    change = np.diff(torque, prepend=torque[0]) * (used > 0)
    change[[gap.index + 1 for gap in recording.gaps]] = 0.0
    return recording.with_signals(sensor=recording.sensor + step * change)
