"""Constant delays of a robot's torques against its positions, as given and as taken away."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from jointid.base.errors import InputError
from jointid.recording.shifting import SHIFTED, checked_shift
from jointid.recording.wide.robot_recording import RobotRecording
from jointid.robot.links.robot import Robot

Array = NDArray[np.float64]

Shift = Mapping[str, float | Sequence[float] | Mapping[str, float]]
"""Delays by signal, of all joints alike, one a joint, or by joints' names [s]; positive: the signal is late."""

_DRIVE = ("torque", "motor_torque")
_FEWEST = 8  # samples


def torque_shift(shift: object, robot: Robot) -> Array:
    """Return the torque's delay of each joint [s] from a `shift` of `identify`, or name what is wrong with it."""
    if not isinstance(shift, Mapping):
        checked_shift(shift)
    assert isinstance(shift, Mapping)
    for signal in shift:
        if signal not in SHIFTED:
            raise InputError(
                "there is no such signal; only the torque of a robot can have a delay removed",
                argument="shift",
                value=signal,
                remedy="pass shift={'torque': seconds}",
            )
        if signal != "torque":
            raise InputError(
                "only the torque of a robot can have a delay removed; a recorded velocity is moved to the "
                "positions' clock by itself",
                argument="shift",
                value=signal,
                remedy="leave it out",
            )
    given: Any = shift.get("torque", 0.0)
    if isinstance(given, Mapping):
        for name in given:
            if name not in robot.names:
                raise InputError("the robot has no such joint", argument="shift", value=name)
        given = [given.get(name, 0.0) for name in robot.names]
    if isinstance(given, list | tuple | np.ndarray):
        if len(given) != robot.n:
            raise InputError(
                f"one for all or one for each of the {robot.n} joints is expected",
                argument="shift.torque",
                value=given,
            )
        return np.array([checked_shift({"torque": each}).get("torque", 0.0) for each in given])
    return np.full(robot.n, checked_shift({"torque": given}).get("torque", 0.0))


def shift_option(delay: Array, robot: Robot) -> dict[str, float | dict[str, float]]:
    """Return delays as a call takes them: one for all joints if they are alike, otherwise by name."""
    if not delay.any():
        return {}
    if np.all(delay == delay[0]):
        return {"torque": round(float(delay[0]), 7)}
    named = zip(robot.names, delay.tolist(), strict=True)
    return {"torque": {name: round(each, 7) for name, each in named if each}}


def without_delay(recording: RobotRecording, robot: Robot, delay: Array) -> RobotRecording:
    """Return a recording with torques moved to the positions' clock; delays [s] are of motors' torques, where recorded.

    Torques are interpolated linearly between their samples, which for a held torque is the mean over the interval.
    Samples at the ends, where a moved torque is not known, are left out.
    """
    if not delay.any():
        return recording
    time = recording.time
    kept = (time + delay.min() >= time[0]) & (time + delay.max() <= time[-1])
    if np.count_nonzero(kept) < _FEWEST:
        raise InputError(
            "the recording is shorter than this delay", argument="shift", value=delay.tolist()
        )
    fields = recording.fields()
    for signal in _DRIVE:
        if fields.get(signal) is None:
            continue
        values = np.array(fields[signal])
        for joint, column in enumerate(robot.columns_of(recording)):
            values[:, column] = np.interp(time + delay[joint], time, values[:, column])
        fields[signal] = values
    for signal in recording.signals:
        fields[signal] = fields[signal][kept]
    return RobotRecording(**{**fields, "extra": {}})
