"""Arguments of `identify` for a robot, checked."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from jointid.base.argument_checks import is_finite, require_kind
from jointid.base.errors import InputError
from jointid.recording.wide.robot_recording import RobotRecording
from jointid.robot.links.robot import Robot
from jointid.robot.motion.motion import Motion

Array = NDArray[np.float64]

_ENOUGH = 10_000  # number of windows
_LONGEST = 0.1  # [s]: longer windows blur reversals and leave few


def recordings_of(recordings: object) -> list[RobotRecording]:
    """Return one recording or several as a list."""
    given = [recordings] if isinstance(recordings, RobotRecording) else recordings
    if not isinstance(given, list | tuple) or not given:
        raise InputError(
            "a RobotRecording, or several, is expected",
            argument="recordings",
            value=recordings,
            remedy='load(path, joints="all") reads a RobotRecording',
        )
    for run in given:
        require_kind("recordings", run, RobotRecording)
    return list(given)


def least_speeds(
    min_speed: float | Sequence[float] | Mapping[str, float] | None, robot: Robot
) -> Array:
    """Return the least speed of each joint [rad/s or m/s]."""
    if min_speed is None:
        return np.zeros(robot.n)
    if isinstance(min_speed, Mapping):
        for name in min_speed:
            if name not in robot.names:
                raise InputError("the robot has no such joint", argument="min_speed", value=name)
        speeds = [min_speed.get(name, 0.0) for name in robot.names]
        given = np.array([float(each) if is_finite(each) else np.nan for each in speeds])
    else:
        try:
            given = np.asarray(min_speed, dtype=np.float64)
        except (OverflowError, TypeError, ValueError):
            given = np.full((0,), np.nan)
        given = np.full(robot.n, float(given)) if given.ndim == 0 else given
    if given.shape != (robot.n,) or not np.all((given >= 0.0) & np.isfinite(given)):
        raise InputError(
            f"speeds of 0 or more are expected, one for all joints or one for each of the {robot.n} joints",
            argument="min_speed",
            value=min_speed,
        )
    return given


def duration_of(windows: float | None, motions: Sequence[Motion], total: float) -> float:
    """Return the duration of the windows [s]: from `windows`, or suitable for the noise of the velocities.

    With a recording of `total` seconds that is long enough, windows may be longer, because there are enough of them.
    """
    if windows is not None:
        number = isinstance(windows, int | float) and not isinstance(windows, bool) and windows > 0
        shortest = min(4.0 * float(np.median(np.diff(motion.time))) for motion in motions)
        most = max(1, int(total / shortest))
        duration = total / windows if number and isinstance(windows, int) else windows
        if not number or not shortest <= duration <= total:
            raise InputError(
                f"a duration from {shortest:.3g} to {total:.4g} seconds is expected, or the number of windows (at "
                f"most {most})",
                argument="windows",
                value=windows,
            )
        return float(duration)
    # The noisiest joint does not decide for the others, because longer windows blur their reversals.
    longest = max(float(np.median(motion.noise_window)) for motion in motions)
    return min(max(longest, total / _ENOUGH), _LONGEST)
