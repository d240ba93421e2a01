"""Largest values that joints reach in a motion, and the worst excess over a limit."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from jointid.base.errors import InputError
from jointid.excitation.judging import Situation
from jointid.simulation.batch import simulate_batch
from jointid.simulation.peaks import Peaks
from jointid.simulation.simulated_recording import SimulatedRecording
from jointid.simulation.trajectory import Trajectory

_CUT = 0.9999  # share of the drive's limit at which a torque counts as cut
_UNLIMITED = 20.0  # times the limit: a torque that shows how much a joint needs
_UNITS = {
    "position": ("rad", "m"),
    "velocity": ("rad/s", "m/s"),
    "acceleration": ("rad/s²", "m/s²"),
    "torque": ("N·m", "N"),
    "sensor_range": ("N·m", "N"),
}
_NAMES = {
    "acceleration": "acceleration of the reference",
    "sensor_range": "torque at the torque sensor",
}


@dataclass
class Reached:
    """The values that joints reach, their shares of the limits, and the joints with the largest values."""

    situation: Situation
    lowest: float = np.inf  # position [rad]
    highest: float = -np.inf
    velocity: float = 0.0  # largest magnitude, also for torque and sensor
    torque: float = 0.0
    sensor: float = 0.0
    # Values of the joint that reaches most, by the limit's name.
    farthest: dict[str, Mapping[str, float]] = field(default_factory=dict)

    def add(
        self, joints: Sequence[Mapping[str, float]], recordings: Sequence[SimulatedRecording]
    ) -> None:
        """Add some joints, by their values and their recordings."""
        period = self.situation.control_period
        low, high = self.situation.limits.position
        middle = 0.5 * (low + high)
        for values, recording in zip(joints, recordings, strict=True):
            true = recording.truth.signals
            # Largest further movement between samples.
            beyond = 0.125 * period * period * float(np.abs(true["acceleration"]).max())
            lowest = float(true["position"].min()) - beyond
            highest = float(true["position"].max()) + beyond
            if max(highest - middle, middle - lowest) > self._aside(middle):
                self.farthest["position"] = values
            self.lowest, self.highest = min(self.lowest, lowest), max(self.highest, highest)
            speed = np.abs(true["velocity"])
            speed[:-1] = speed[:-1] + 0.5 * period * np.abs(np.diff(true["acceleration"]))
            self.velocity = self._largest("velocity", values, self.velocity, speed)
            self.torque = self._largest("torque", values, self.torque, recording.torque)
            if self.situation.joint.sensor:
                self.sensor = self._largest(
                    "sensor_range", values, self.sensor, true["link_torque"]
                )

    def shares(self, trajectory: Trajectory) -> dict[str, float]:
        """Return the used share of each limit, by its name; above 1 it is exceeded."""
        limits = self.situation.limits
        low, high = limits.position
        shares = {
            "position": self._aside(0.5 * (low + high)) / (0.5 * (high - low)),
            "velocity": self.velocity / limits.velocity,
        }
        if limits.acceleration is not None:
            shares["acceleration"] = self.peaks(trajectory).acceleration / limits.acceleration
        if limits.sensor_range is not None:
            shares["sensor_range"] = self.sensor / limits.sensor_range
        # The drive cuts a torque beyond its limit, so the joint does not follow a motion that needs all of it.
        if self.torque >= _CUT * self.situation.torque:
            shares["torque"] = 1.02
        return shares

    def peaks(self, trajectory: Trajectory) -> Peaks:
        """Return the reached values, with the acceleration of the reference."""
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

    def _aside(self, middle: float) -> float:
        """Return the largest distance of a joint from the middle of the window; -inf before any was added."""
        return max(self.highest - middle, middle - self.lowest)

    def _largest(
        self,
        name: str,
        values: Mapping[str, float],
        before: float,
        signal: NDArray[np.float64] | None,
    ) -> float:
        found = 0.0 if signal is None else float(np.abs(signal).max())
        if found <= before:
            return before
        self.farthest[name] = values
        return found


def exceeded(situation: Situation, trajectory: Trajectory, reached: Reached) -> str:
    """Return one sentence about the limit that is exceeded most, with the excess and the joint."""
    shares = reached.shares(trajectory)
    name = max(shares, key=lambda each: shares[each])
    joint = reached.farthest.get(name, {})
    peaks, limits = reached.peaks(trajectory), situation.limits
    unit = _UNITS[name][situation.joint.kind == "prismatic"]
    if name == "position":
        low, high = limits.position
        lowest, highest = peaks.position
        return (
            f"the position reaches {lowest:.4g} to {highest:.4g} {unit}, outside {low:.4g} to {high:.4g} {unit}"
            f"{described(joint)}"
        )
    if name == "torque":
        allowed = situation.torque
        needed = _needed(situation, trajectory, joint)
        said = f"is cut at the limit of {allowed:.4g} {unit}"
        if needed:
            over = _over(needed / allowed)
            said = f"would have to be {needed:.4g} {unit}, {over} the limit of {allowed:.4g} {unit}"
        return f"the torque {said}{described(joint)}"
    value = {
        "velocity": peaks.velocity,
        "acceleration": peaks.acceleration,
        "sensor_range": peaks.sensor_torque or 0.0,
    }[name]
    allowed = getattr(limits, name)
    own = "" if name == "acceleration" else described(joint)
    return (
        f"the {_NAMES.get(name, name)} reaches {value:.4g} {unit}, {_over(value / allowed)} the limit of "
        f"{allowed:.4g} {unit}{own}"
    )


def _over(ratio: float) -> str:
    percent = 100.0 * (ratio - 1.0)
    if percent >= 1000.0:
        return f"{ratio:.3g} times"
    return f"{percent:.2g} % more than" if percent < 10.0 else f"{percent:.0f} % more than"


def described(joint: Mapping[str, float]) -> str:
    """Return the values of a joint as the end of a sentence."""
    values = ", ".join(f"{name} {value:.3g}" for name, value in joint.items())
    return f", for a joint with {values}" if values else ""


def _needed(situation: Situation, trajectory: Trajectory, joint: Mapping[str, float]) -> float:
    """Return the torque that a joint would need from a stronger drive; 0 if it is unknown."""
    stronger = replace(situation.limits, torque=_UNLIMITED * situation.torque)
    try:
        batch = simulate_batch(
            [replace(situation, limits=stronger).with_values(joint)],
            situation.controller,
            trajectory,
            control_period=situation.control_period,
            sensors=situation.sensors,
            seeds=[0],
            recordings=True,
        )
    except InputError:
        return 0.0
    torque = batch.recordings[0].torque
    needed = 0.0 if torque is None else float(np.abs(torque).max())
    return needed if 1.0 < needed / situation.torque < _CUT * _UNLIMITED else 0.0
