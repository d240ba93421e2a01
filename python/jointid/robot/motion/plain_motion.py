"""A robot's signals as they were given, filtered alike: what a quick regression by hand begins with.

Nothing here comes from the identification: no mask, no window, no derived velocity, no delay, no repaired stamps.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from jointid.problem.low_pass import low_passed, reach
from jointid.recording.wide.robot_recording import RobotRecording
from jointid.robot.links.momentum import columns_of
from jointid.robot.links.robot import Robot
from jointid.robot.motion.driven import is_held
from jointid.robot.motion.motion import part_of, recorded_velocity, signals_of

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]

PERIOD = 0.05  # [s], of the moving average
_LEAST = 5  # samples in it
_FINER = 4  # times shorter is the average before products of signals are made
_EACH = 10  # samples that are kept of one average
_PIECE, _PIECES = 2_000, 10  # samples that are kept of a stretch, and stretches of all recordings
_SHORTEST = 40  # of these: less is no motion


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class PlainSignals:
    """A stretch of a recording on an even clock, all at the joints; rows are joints: (n, samples)."""

    position: Array  # counted from the recording's own zeros
    velocity: Array  # slope of the filtered position
    torque: Array
    recorded: Array | None  # the velocity in the recording
    step: float  # [s]
    period: float  # the moving average that fits the recording's rate [s]
    whole: Flags  # (samples,), where no gap is near


def plain_signals(recordings: Sequence[RobotRecording], robot: Robot) -> list[PlainSignals]:
    """Return recordings in stretches; of long ones some, evenly spread."""
    return [_stretch(robot, run) for run in stretches(recordings, _PIECES)]


def stretches(recordings: Sequence[RobotRecording], most: int) -> list[RobotRecording]:
    """Return at most so many stretches of recordings, evenly spread."""
    pieces = [piece for run in recordings for piece in _pieces(run)]
    count = min(len(pieces), most)
    middles = (np.arange(count) + 0.5) * len(pieces) / max(count, 1)  # many stand still at the ends
    return [part_of(*pieces[int(middle)]) for middle in middles]


def _rate(run: RobotRecording) -> tuple[float, float, int]:
    """The usual step, the average's period, and how many samples are one."""
    step = float(np.median(np.diff(run.time)))
    period = max(PERIOD, _LEAST * step)
    return step, period, max(1, round(period / _EACH / step))


def _pieces(run: RobotRecording) -> Iterator[tuple[RobotRecording, int, int]]:
    *_, every = _rate(run)
    count = max(1, round(run.samples / (_PIECE * every)))
    edges = np.linspace(0, run.samples, count + 1).round().astype(int).tolist()
    for first, end in itertools.pairwise(edges):
        if end - first >= _SHORTEST * every:
            yield run, first, end


def _stretch(robot: Robot, run: RobotRecording) -> PlainSignals:
    step, period, every = _rate(run)
    position, torque, at_motor = signals_of(run, robot)
    given = velocity_of(run, robot, at_motor)
    if at_motor:
        position = np.asarray(np.linalg.solve(robot.couplings, position), dtype=np.float64)
    clock = np.arange(run.time[0], run.time[-1], step)
    held = 0.5 * step if is_held(run, robot) else 0.0
    width = round(period / _FINER / step)

    def even(rows: Array, late: float = 0.0) -> Array:
        on_clock = [np.interp(clock, run.time + late, row) for row in rows]
        return low_passed(np.array(on_clock), width)

    smooth = even(position)
    gaps = np.flatnonzero(np.diff(run.time) > max(0.5 * period, 3.0 * step))
    whole = np.ones(clock.size, dtype=bool)
    for gap in gaps:
        whole[np.searchsorted(clock, run.time[gap]) : np.searchsorted(clock, run.time[gap + 1])] = (
            False
        )
    whole[: reach(width)] = whole[clock.size - reach(width) :] = False
    return PlainSignals(
        position=smooth[:, ::every],
        velocity=np.gradient(smooth, step, axis=1)[:, ::every],
        torque=even(torque, held)[:, ::every],
        recorded=None if given is None else even(given)[:, ::every],
        step=step * every,
        period=period,
        whole=np.logical_and.reduceat(whole, np.arange(0, clock.size, every)),
    )


def velocity_of(run: RobotRecording, robot: Robot, at_motor: bool) -> Array | None:
    """The recorded velocity at the joints."""
    found = recorded_velocity(run, robot, at_motor)
    if found is None or not at_motor:
        return found
    return np.asarray(np.linalg.solve(robot.couplings, found))


def link_columns(
    robot: Robot, position: Array, velocity: Array, step: float, directions: Array
) -> Array:
    """Torques of all joints by changes of the links' inertial parameters, shape (n, columns, samples).

    They are the momentum's slope less the force of motion and gravity; `step` is in s, `directions` is (10 n, columns).
    """
    offsets = np.array(robot.zero_offsets or (0.0,) * robot.n)[:, None]
    momentum, force = columns_of(robot.tree, position + offsets, velocity)
    found = np.zeros((robot.n, directions.shape[1], position.shape[1]))
    for number, (joint, link) in enumerate(robot.tree.pairs):
        turned = directions[10 * link : 10 * link + 10].T
        found[joint] += np.gradient(turned @ momentum[number], step, axis=1)
        found[joint] -= turned @ force[number]
    return found
