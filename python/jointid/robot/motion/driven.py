"""Torques of a position drive from wanted positions, and their change with the delay of these positions."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Self

import numpy as np
from numpy.typing import NDArray

from jointid.base.advice import Action
from jointid.base.errors import InputError
from jointid.recording.wide.robot_recording import RobotRecording
from jointid.robot.links.position_drive import PositionDrive
from jointid.robot.links.robot import Robot

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Driven:
    """The parts of a drive's torques on the recording's side; each value is a mean until the next sample."""

    drive: PositionDrive
    time: Array
    wanted: Array  # (n, samples), wanted positions, on the recording's side
    command: Array  # torque that follows the wanted position, on the recording's side
    state: Array  # the rest of the torque, on the recording's side
    factor: Array  # (n,), factor to the torque at the joint

    @classmethod
    def of(
        cls, recording: RobotRecording, drive: PositionDrive, columns: list[int], factor: Array
    ) -> Self:
        """Return the torques from some columns of a recording."""
        wanted = recording.reference
        if wanted is None or not np.all(np.isfinite(wanted[:, columns])):
            lacking = [
                recording.names[column]
                for column in columns
                if wanted is None or not np.all(np.isfinite(wanted[:, column]))
            ]
            raise InputError(
                f"the wanted positions of {', '.join(lacking)} are missing, and the drive needs them",
                place=recording.name,
                remedy=Action(
                    "call",
                    {"columns": {"reference": ...}},
                    "write {joint} in the header in place of the joint's name",
                    "load",
                ),
            )
        position = recording.position[:, columns].T
        return cls(
            drive=drive,
            time=recording.time,
            wanted=wanted[:, columns].T,
            command=drive.torque_of_command(wanted[:, columns].T),
            state=drive.torque_of_state(recording.time, position),
            factor=factor,
        )

    def torque(self, delay: Array | None = None) -> Array:
        """Return the torques at the joints, (n, samples), if the wanted positions act later by further delays [s]."""
        command = self.command
        if delay is not None:
            command = np.array(
                [earlier(self.time, row, late) for late, row in zip(delay, command, strict=True)]
            )
        return self.factor[:, None] * self.drive.limited(command + self.state)


def earlier(time: Array, values: Array, late: float) -> Array:
    """Return the values of a smooth signal `late` seconds before each sample, by cubics through four samples."""
    place = np.interp(time - late, time, np.arange(time.size, dtype=np.float64))
    first = np.clip(np.floor(place).astype(np.int64) - 1, 0, time.size - 4)
    x = place - first
    weights = (
        -(x - 1.0) * (x - 2.0) * (x - 3.0) / 6.0,
        x * (x - 2.0) * (x - 3.0) / 2.0,
        -x * (x - 1.0) * (x - 3.0) / 2.0,
        x * (x - 1.0) * (x - 2.0) / 6.0,
    )
    return np.asarray(sum(weight * values[first + k] for k, weight in enumerate(weights)))


def is_held(recording: RobotRecording, robot: Robot) -> bool:
    """Return whether a torque is held until the next sample, so that each value is the mean until then."""
    return robot.drive is not None or recording.torque_hold == "zoh"
