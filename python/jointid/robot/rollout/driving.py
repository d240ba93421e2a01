"""What drives a robot along a log: its torques as logged, or its position loop with the logged commands."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from jointid.recording.wide.robot_recording import RobotRecording
from jointid.robot.links.robot import Robot
from jointid.robot.motion.driven import Driven
from jointid.robot.motion.motion import Motion, ratios_of_positions
from jointid.robot.rollout.stepping import State

Array = NDArray[np.float64]


class Driving(Protocol):
    """Torques of the joints."""

    def torque(self, row: int, share: float, state: State) -> tuple[Array, Array]:
        """Return the torques a share of the time from a row to the next one, and by how much they fall per speed."""
        ...


def driving_of(motion: Motion, robot: Robot, recording: RobotRecording) -> Driving:
    """Return what drives the robot in a recording, of which `motion` is."""
    if motion.driven is None:
        return _Logged(motion)
    zeros = np.array(robot.zero_offsets or (0.0,) * robot.n)
    return _Loop(motion.driven, ratios_of_positions(recording, robot), zeros)


@dataclass(frozen=True, slots=True, eq=False)
class _Logged:
    motion: Motion

    def torque(self, row: int, share: float, state: State) -> tuple[Array, Array]:
        del state
        torque = self.motion.torque
        share = 0.0 if self.motion.torque_held else share
        now = (1.0 - share) * torque[:, row] + share * torque[:, row + 1]
        return now, np.zeros(len(now))


@dataclass(frozen=True, slots=True, eq=False)
class _Loop:
    driven: Driven
    ratios: Array  # recorded position per position of the joint
    zeros: Array  # [rad or m]

    def torque(self, row: int, share: float, state: State) -> tuple[Array, Array]:
        del share
        drive = self.driven.drive
        position = self.ratios * (state.position - self.zeros)
        wanted = self.driven.command[:, row] + drive.torque_at(
            position, self.ratios * state.velocity
        )
        held = drive.limited(wanted[:, None])[:, 0]
        damping = self.driven.factor * self.ratios * np.array(drive.kd)
        return self.driven.factor * held, np.where(held == wanted, damping, 0.0)
