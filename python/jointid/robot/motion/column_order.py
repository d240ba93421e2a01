"""Exchange columns of a robot's recording."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from jointid.recording.wide.robot_recording import RobotRecording
from jointid.robot.links.robot import Robot

Whole = NDArray[np.int64]


def reordered(
    recording: RobotRecording, robot: Robot, order: Whole | None, torque_order: Whole | None
) -> RobotRecording:
    """Return a recording in which each joint has the columns at its place in `order`; None keeps the columns."""
    columns = np.array(robot.columns_of(recording))
    fields = recording.fields()
    moving, pushing = (
        ["position", "velocity", "link_position"],
        ["torque", "motor_torque", "current"],
    )
    (moving if robot.drive is None else pushing).append("reference")
    orders = dict.fromkeys(moving, order) | dict.fromkeys(pushing, torque_order)
    for signal, each in orders.items():
        if each is not None and fields.get(signal) is not None:
            values = np.array(fields[signal])
            values[:, columns] = values[:, columns[each]]
            fields[signal] = values
    return RobotRecording(**fields)
