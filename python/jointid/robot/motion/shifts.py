"""Constant delays of a robot's torques against its positions, as stated and as removed."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from jointid.base.errors import InputError
from jointid.recording.shifting import SHIFTED, checked_shift
from jointid.recording.wide.robot_recording import RobotRecording
from jointid.robot.links.robot import Robot
from jointid.robot.motion.driven import earlier

Array = NDArray[np.float64]

Shift = Mapping[str, float | Sequence[float] | Mapping[str, float]]
"""Delays by signal [s]: one for all joints, one for each, or by joints' names; positive: the signal is late."""

FILTER = "torque_filter"
"""Key of a `shift` for the time constants of the torques' first-order low-pass filters [s]."""
_DRIVE = ("torque", "motor_torque")
_FEWEST = 8  # samples
COMMAND = "reference"


def requested_delay(shift: object, robot: Robot) -> Array | None:
    """Return the delay of each joint that a call or a drive states [s]; None if it is to be identified."""
    if shift is not None:
        return torque_shift(shift, robot)
    if robot.drive is not None and robot.drive.delay is not None:
        return np.array(robot.drive.delay)
    return None


def torque_shift(shift: object, robot: Robot) -> Array:
    """Return the torque's delay of each joint [s] from a `shift` of `identify`, or name the fault in it.

    With a drive, it is the delay of the wanted position's effect.
    """
    if not isinstance(shift, Mapping):
        checked_shift(shift)
    assert isinstance(shift, Mapping)
    moved = _moved(robot)
    for signal in shift:
        if signal == moved or (signal == FILTER and moved != COMMAND):
            continue
        if moved == COMMAND:
            raise InputError(
                "the recording has no torque; only the delay of the wanted positions can be stated",
                argument="shift",
                value=signal,
                remedy=f"pass shift={{'{COMMAND}': seconds}}",
            )
        if signal not in SHIFTED:
            raise InputError(
                "there is no such signal; only the delay of a robot's torque can be removed",
                argument="shift",
                value=signal,
                remedy="pass shift={'torque': seconds}",
            )
        raise InputError(
            "only the delay of a robot's torque can be removed; the delay of a recorded velocity is removed "
            "automatically",
            argument="shift",
            value=signal,
            remedy="leave it out",
        )
    return _of_joints(shift, moved, robot)


def torque_lag(shift: Mapping[str, Any], robot: Robot) -> Array:
    """Return the time constant of each torque's low-pass filter [s] from a `shift` that `torque_shift` has checked."""
    found = _of_joints(shift, FILTER, robot)
    if found.min() < 0.0:
        raise InputError(
            "a time constant of at least 0 is expected",
            argument=f"shift.{FILTER}",
            value=shift[FILTER],
        )
    return found


def _of_joints(shift: Mapping[str, Any], key: str, robot: Robot) -> Array:
    given = shift.get(key, 0.0)
    if isinstance(given, Mapping):
        for name in given:
            if name not in robot.names:
                raise InputError("the robot has no such joint", argument="shift", value=name)
        given = [given.get(name, 0.0) for name in robot.names]
    if isinstance(given, list | tuple | np.ndarray):
        if len(given) != robot.n:
            raise InputError(
                f"one number for all joints, or one for each of the {robot.n} joints, is expected",
                argument=f"shift.{key}",
                value=given,
            )
        return np.array([checked_shift({"torque": each}).get("torque", 0.0) for each in given])
    return np.full(robot.n, checked_shift({"torque": given}).get("torque", 0.0))


def _moved(robot: Robot) -> str:
    """Return the name of the signal that is late."""
    return "torque" if robot.drive is None else COMMAND


def shift_option(
    delay: Array, robot: Robot, lag: Array | None = None
) -> dict[str, float | dict[str, float]]:
    """Return delays and filters as an argument of a call: one for all joints if they are alike, otherwise by name."""
    found: dict[str, float | dict[str, float]] = {}
    for key, values in ((_moved(robot), delay), (FILTER, lag)):
        if values is None or not values.any():
            continue
        if np.all(values == values[0]):
            found[key] = round(float(values[0]), 7)
        else:
            named = zip(robot.names, values.tolist(), strict=True)
            found[key] = {name: round(each, 7) for name, each in named if each}
    return found


def on_the_clock_of_positions(
    recording: RobotRecording, robot: Robot, delay: Array, lag: Array | None
) -> RobotRecording:
    """Return a recording with the torques' filters undone, then their delays removed [s]."""
    if lag is not None:
        recording = without_lag(recording, robot, lag)
    return without_delay(recording, robot, delay)


def without_lag(recording: RobotRecording, robot: Robot, lag: Array) -> RobotRecording:
    """Return a recording with torques before their first-order low-pass filter; `lag`: its time constants [s]."""
    if not lag.any():
        return recording
    fields = recording.fields()
    for signal in _DRIVE:
        if fields.get(signal) is None:
            continue
        values = np.array(fields[signal])
        for joint, column in enumerate(robot.columns_of(recording)):
            values[:, column] += lag[joint] * np.gradient(values[:, column], recording.time)
        fields[signal] = values
    return RobotRecording(**{**fields, "extra": {}})


def without_delay(recording: RobotRecording, robot: Robot, delay: Array) -> RobotRecording:
    """Return a recording with torques moved to the positions' clock; delays [s] belong to the recorded torques.

    With a drive, wanted positions are moved to the time of their effect. Torques are interpolated linearly between
    their samples; for a held torque this is the mean over the interval. Samples at the ends without a known moved
    signal are removed.
    """
    if not delay.any():
        return recording
    time, shift = recording.time, delay if robot.drive is None else -delay
    kept = (time + shift.min() >= time[0]) & (time + shift.max() <= time[-1])
    if np.count_nonzero(kept) < _FEWEST:
        raise InputError(
            "the recording is shorter than this delay", argument="shift", value=delay.tolist()
        )
    fields = recording.fields()
    for signal in _DRIVE if robot.drive is None else (COMMAND,):
        if fields.get(signal) is None:
            continue
        values = np.array(fields[signal])
        for joint, column in enumerate(robot.columns_of(recording)):
            row = values[:, column]
            values[:, column] = (
                np.interp(time + delay[joint], time, row)
                if robot.drive is None
                else earlier(time, row, delay[joint])
            )
        fields[signal] = values
    for signal in recording.signals:
        fields[signal] = fields[signal][kept]
    return RobotRecording(**{**fields, "extra": {}})
