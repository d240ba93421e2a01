"""Torques along a log: logged torques, or those of the position loop with logged commands."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from jointid.recording.wide.robot_recording import RobotRecording
from jointid.robot.links.robot import Robot
from jointid.robot.motion.driven import Driven
from jointid.robot.motion.motion import Motion, ratios_of_positions
from jointid.robot.rollout.stepping import Push, State

Array = NDArray[np.float64]


class Driving(Protocol):
    """Torques of the joints along a log."""

    def push(self, row: int, share: float, state: State) -> Push:
        """Return the torques at a time between two rows; `share` is its share of the interval after `row`."""


def driving_of(motion: Motion, robot: Robot, recording: RobotRecording) -> Driving:
    """Return the driving torques of a recording; `motion` is that of the recording."""
    if motion.driven is None:
        return _Logged(motion.torque, motion.torque_held)
    zeros = np.array(robot.zero_offsets or (0.0,) * robot.n)
    return _Loop(motion.driven, ratios_of_positions(recording, robot), zeros)


@dataclass(frozen=True, slots=True, eq=False)
class _Logged:
    torque: Array
    held: bool

    def push(self, row: int, share: float, state: State) -> Push:
        del state
        torque = _between(self.torque, row, 0.0 if self.held else share)
        return Push(torque, np.zeros(len(torque)))


@dataclass(frozen=True, slots=True, eq=False)
class _Loop:
    driven: Driven
    ratios: Array  # recorded position per position of the joint
    zeros: Array  # [rad or m]

    def push(self, row: int, share: float, state: State) -> Push:
        drive, factor = self.driven.drive, self.driven.factor
        wanted = _between(self.driven.wanted, row, 0.0 if drive.hold == "zoh" else share)
        error = wanted - self.ratios * (state.position - self.zeros)
        torque = drive.torque_at(error, self.ratios * state.velocity)
        limited = drive.limited(torque[:, None])[:, 0]
        damping = factor * self.ratios * np.array(drive.kd)
        return Push(factor * limited, np.where(limited == torque, damping, 0.0))


def _between(rows: Array, row: int, share: float) -> Array:
    return np.asarray((1.0 - share) * rows[:, row] + share * rows[:, row + 1])
