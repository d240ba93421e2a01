"""Limits that hold for every joint of the prior, with noise, between samples."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from jointid.base.errors import InputError
from jointid.design.judging import Situation
from jointid.design.reaching import Reached, described, exceeded
from jointid.simulation.batch import simulate_batch
from jointid.simulation.peaks import Peaks
from jointid.simulation.simulated_recording import SimulatedRecording
from jointid.simulation.trajectory import Trajectory

_JOINTS = 48
_CORNERS = 16  # of the prior
_STEPS = 6  # times that a motion is made smaller
_TOGETHER = 16


def held_by_all(
    situation: Situation, trajectory: Trajectory, seed: int, threads: int
) -> tuple[Trajectory, Peaks, str]:
    """Return the motion, made smaller until many joints keep all limits, and what they reach.

    Returns
    -------
    trajectory : Trajectory
    peaks : Peaks
        Of all these joints.
    problem : str
        Empty if all limits are kept, else a sentence: of which limit, by how much, and for which joint.
    """
    joints = situation.ranges.joints(_JOINTS, seed + 1)
    joints += situation.ranges.corners(_CORNERS, seed + 2)
    reached = Reached(situation)
    for step in range(_STEPS):
        reached = Reached(situation)
        for begin in range(0, len(joints), _TOGETHER):
            values = joints[begin : begin + _TOGETHER]
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
        if share <= 1.0:
            return trajectory, reached.peaks(trajectory), ""
        if step < _STEPS - 1:
            trajectory = _smaller(trajectory, 0.99 / share)
    return trajectory, reached.peaks(trajectory), exceeded(situation, trajectory, reached)


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
    """The first joint whose loop is not stable, for a sentence."""
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
