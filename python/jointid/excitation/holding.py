"""Reduce a motion until every joint of the prior keeps the limits, with noise, between samples."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from jointid.base.errors import InputError
from jointid.excitation.judging import Situation
from jointid.excitation.reaching import Reached, described, exceeded
from jointid.simulation.batch import simulate_batch
from jointid.simulation.peaks import Peaks
from jointid.simulation.simulated_recording import SimulatedRecording
from jointid.simulation.trajectory import Trajectory

_JOINTS = 48
_CORNERS = 16  # corners of the prior's ranges
_STEPS = 8  # number of reductions
_AIM = 0.99  # share of the limit to reach
_LEAST = 0.8  # smallest size in one step, relative to the last
_TOGETHER = 16


def shrunk(
    situation: Situation, trajectory: Trajectory, seed: int, threads: int
) -> tuple[Trajectory, Peaks, str]:
    """Return the motion, reduced until many joints keep all limits, and the values that they reach.

    The last value describes the exceeded limit, the excess and the joint. It is empty if all limits are kept.
    """
    joints = situation.ranges.joints(_JOINTS, seed + 1)
    joints += situation.ranges.corners(_CORNERS, seed + 2)
    # Corners first: they move farthest. If a motion is too large for them, the other joints need no test.
    groups = [(at, joints[at : at + _TOGETHER]) for at in range(0, len(joints), _TOGETHER)][::-1]
    tried: list[tuple[float, float]] = []
    size = 1.0
    while True:
        reached = Reached(situation)
        for number, (begin, values) in enumerate(groups):
            try:
                reached.add(
                    values, _recordings(situation, trajectory, values, seed + begin, threads)
                )
            except InputError as error:
                problem = (
                    f"the loop is not stable{_unstable(situation, trajectory, values)}: {error}"
                )
                return trajectory, reached.peaks(trajectory), problem
            share = max(reached.shares(trajectory).values())
            if share > 1.0 and len(tried) < _STEPS - 1:
                groups.insert(0, groups.pop(number))
                break
        if share <= 1.0:
            return trajectory, reached.peaks(trajectory), ""
        if len(tried) == _STEPS - 1:
            return trajectory, reached.peaks(trajectory), exceeded(situation, trajectory, reached)
        tried.append((size, share))
        smaller = _next_size(tried)
        trajectory, size = _smaller(trajectory, smaller / size), smaller


def _next_size(tried: Sequence[tuple[float, float]]) -> float:
    """Return the next size of the motion, from the tried sizes and the largest share of a limit at each.

    A position scales with the motion. In a torque, friction and gravity do not. From the second size on the
    share is therefore extrapolated from the last two, but to at least four fifths of the size.
    """
    size, share = tried[-1]
    proportional = _AIM / share * size
    if len(tried) < 2:
        return proportional
    larger, before = tried[-2]
    slope = (before - share) / (larger - size)
    if slope <= 0.0:
        return max(proportional, _LEAST * size) * _LEAST
    return min(proportional, max(size - (share - _AIM) / slope, _LEAST * size))


def _recordings(
    situation: Situation,
    trajectory: Trajectory,
    joints: Sequence[Mapping[str, float]],
    seed: int,
    threads: int,
) -> Sequence[SimulatedRecording]:
    batch = simulate_batch(
        [situation.with_values(each) for each in joints],
        situation.controller,
        trajectory,
        control_period=situation.control_period,
        sensors=situation.sensors,
        seeds=[seed + number for number in range(len(joints))],
        recordings=True,
        threads=threads,
    )
    return batch.recordings


def _unstable(
    situation: Situation, trajectory: Trajectory, joints: Sequence[Mapping[str, float]]
) -> str:
    """Return the first joint with an unstable loop, as part of a sentence."""
    for each in joints:
        try:
            _recordings(situation, trajectory, [each], 0, 1)
        except InputError:
            return described(each)
    return ""


def _smaller(trajectory: Trajectory, share: float) -> Trajectory:
    arguments = dict(trajectory.arguments)
    arguments["amplitude"] = tuple(share * each for each in arguments["amplitude"])
    return Trajectory.sines(**arguments)
