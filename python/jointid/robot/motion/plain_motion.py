"""A robot's signals as recorded, with the same filter for all: the start of a quick regression by hand.

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

PERIOD = 0.05  # [s], period of the moving average
_LEAST = 5  # smallest number of samples in it
_FINER = 4  # factor by which the average is shorter before products of signals are formed
_EACH = 10  # samples that are kept of one average
_PIECE, _PIECES = 2_000, 10  # samples that are kept of a stretch, and stretches of all recordings
_SHORTEST = 40  # of these samples: fewer are not usable


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class PlainSignals:
    """A stretch of a recording on an even clock, all at the joints; rows are joints: (n, samples)."""

    position: Array  # counted from the recording's own zeros
    velocity: Array  # derivative of the filtered position
    torque: Array
    recorded: Array | None  # recorded velocity
    step: float  # [s]
    period: float  # period of the moving average, for the recording's rate [s]
    whole: Flags  # (samples,), True if no gap is near


def plain_signals(recordings: Sequence[RobotRecording], robot: Robot) -> list[PlainSignals]:
    """Return recordings in stretches; from long ones some stretches, evenly spaced."""
    return [_stretch(robot, run) for run in stretches(recordings, _PIECES)]


def stretches(recordings: Sequence[RobotRecording], most: int) -> list[RobotRecording]:
    """Return at most `most` stretches of recordings, evenly spaced."""
    pieces = [piece for run in recordings for piece in _pieces(run)]
    count = min(len(pieces), most)
    # because many recordings stand still at the ends
    middles = (np.arange(count) + 0.5) * len(pieces) / max(count, 1)
    return [part_of(*pieces[int(middle)]) for middle in middles]


def _rate(run: RobotRecording) -> tuple[float, float, int]:
    """Return the usual step, the average's period, and the number of samples per kept sample."""
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
    """Return the recorded velocity at the joints."""
    found = recorded_velocity(run, robot, at_motor)
    if found is None or not at_motor:
        return found
    return np.asarray(np.linalg.solve(robot.couplings, found))


def link_columns(
    robot: Robot, position: Array, velocity: Array, step: float, directions: Array
) -> Array:
    """Return torques of all joints per change of the links' inertial parameters, shape (n, columns, samples).

    They are the derivative of the momentum minus the force of motion and gravity. `step` is in s, `directions` is
    (10 n, columns).
    """
    offsets = np.array(robot.zero_offsets or (0.0,) * robot.n)[:, None]
    momentum, force = columns_of(robot.tree, position + offsets, velocity)
    found = np.zeros((robot.n, directions.shape[1], position.shape[1]))
    for number, (joint, link) in enumerate(robot.tree.pairs):
        turned = directions[10 * link : 10 * link + 10].T
        found[joint] += np.gradient(turned @ momentum[number], step, axis=1)
        found[joint] -= turned @ force[number]
    return found
