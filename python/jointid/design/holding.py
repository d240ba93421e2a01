"""Limits that hold for every joint of the prior, with noise, between samples."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from jointid.base.errors import InputError
from jointid.design.judging import Situation
from jointid.simulation.batch import simulate_batch
from jointid.simulation.peaks import Peaks
from jointid.simulation.simulated_recording import SimulatedRecording
from jointid.simulation.trajectory import Trajectory

_JOINTS = 48
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
        Empty if all limits are kept, else a sentence.
    """
    joints = situation.ranges.joints(_JOINTS, seed + 1)
    for _ in range(_STEPS):
        reached = _Reached(situation)
        for begin in range(0, len(joints), _TOGETHER):
            values = joints[begin : begin + _TOGETHER]
            try:
                batch = simulate_batch(
                    [situation.with_values(each) for each in values],
                    situation.controller,
                    trajectory,
                    control_period=situation.control_period,
                    sensors=situation.sensors,
                    seeds=[seed + begin + i for i in range(len(values))],
                    recordings=True,
                    threads=threads,
                )
            except InputError as error:
                return trajectory, reached.peaks(trajectory), f"the loop is not stable: {error}"
            reached.add(batch.recordings)
        share = reached.share()
        if share <= 1.0:
            return trajectory, reached.peaks(trajectory), ""
        trajectory = _smaller(trajectory, 0.99 / share)
    return trajectory, reached.peaks(trajectory), "some joint of the prior exceeds a limit"


@dataclass
class _Reached:
    """What joints reach, and how much of the limits that is."""

    situation: Situation
    lowest: float = np.inf
    highest: float = -np.inf
    velocity: float = 0.0
    torque: float = 0.0
    sensor: float = 0.0

    def add(self, recordings: Sequence[SimulatedRecording]) -> None:
        period = self.situation.control_period
        for recording in recordings:
            true = recording.truth.signals
            # Between samples it goes on by at most this.
            beyond = 0.125 * period * period * float(np.abs(true["acceleration"]).max())
            speed = np.abs(true["velocity"])
            speed[:-1] = speed[:-1] + 0.5 * period * np.abs(np.diff(true["acceleration"]))
            self.lowest = min(self.lowest, float(true["position"].min()) - beyond)
            self.highest = max(self.highest, float(true["position"].max()) + beyond)
            self.velocity = max(self.velocity, float(speed.max()))
            self.torque = max(self.torque, _largest(recording.torque))
            if self.situation.joint.sensor:
                self.sensor = max(self.sensor, float(np.abs(true["link_torque"]).max()))

    def share(self) -> float:
        """Return the largest share of a limit; above 1 it is exceeded."""
        limits = self.situation.limits
        low, high = limits.position
        middle, half = 0.5 * (low + high), 0.5 * (high - low)
        shares = [
            max(self.highest - middle, middle - self.lowest) / half,
            self.velocity / limits.velocity,
        ]
        if limits.sensor_range is not None:
            shares.append(self.sensor / limits.sensor_range)
        # The drive cuts what is beyond its limit: a motion that needs all of it is not followed.
        if self.torque >= 0.9999 * self.situation.torque:
            shares.append(1.02)
        return max(shares)

    def peaks(self, trajectory: Trajectory) -> Peaks:
        time = np.arange(0.0, trajectory.duration, self.situation.control_period)
        acceleration = trajectory.sample(time)[2]
        known = np.isfinite(self.lowest)
        return Peaks(
            position=(self.lowest, self.highest) if known else (0.0, 0.0),
            velocity=self.velocity,
            acceleration=float(np.abs(acceleration).max()),
            torque=self.torque,
            sensor_torque=self.sensor if self.situation.joint.sensor else None,
        )


def _smaller(trajectory: Trajectory, share: float) -> Trajectory:
    arguments = dict(trajectory.arguments)
    arguments["amplitude"] = tuple(share * each for each in arguments["amplitude"])
    return Trajectory.sines(**arguments)


def _largest(values: NDArray[np.float64] | None) -> float:
    return 0.0 if values is None else float(np.abs(values).max())
