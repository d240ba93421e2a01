"""Short pushes just above breakaway: inertia and the torque sensor's sign, within a fraction of a degree."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from jointid.hardware.proof.axis import Axis, Trace

STRENGTH = 1.15  # of the breakaway in its direction
_LONGEST = 0.4  # [s] of a push
_DEGREE = 5  # of the polynomial that stands for what the sensor reads at a position
_UNKNOWN = 8  # rows at least, for four unknowns
_FEWEST = 50  # samples in motion, to say anything


@dataclass(frozen=True, slots=True)
class Push:
    """One push, seen in its own direction, from its first cycle until the joint stands.

    Attributes
    ----------
    trace : Trace
    direction : float
        1 or -1.
    """

    trace: Trace
    direction: float

    @property
    def width(self) -> float:
        """Angle that it took [rad]."""
        return float(np.ptp(self.trace.position))

    @property
    def fastest(self) -> float:
        """Highest speed between two samples [rad/s]."""
        steps = np.abs(np.diff(self.trace.position)) / np.diff(self.trace.time)
        return float(steps.max(initial=0.0))


def push(axis: Axis, direction: float, torque: float, reach: float) -> Push:
    """Push until the joint has gone `reach` [rad], then let it come to rest under no torque.

    Raises
    ------
    RefusedBenchError
        A bound of the axis.
    """
    begin = len(axis.rows)
    place, end = axis.sample.position, axis.now + _LONGEST
    while abs(axis.read().position - place) < reach and axis.now < end:
        axis.command(direction * torque)
    axis.rest()
    return Push(axis.trace(begin), direction)


@dataclass(frozen=True, slots=True)
class Motion:
    """What pushes say of the joint, by the joint file's constants.

    Attributes
    ----------
    inertia : float
        [kg·m²]; not a number where it cannot be told.
    friction, viscous : float
        While it slides [N·m], [N·m·s/rad].
    load : float
        That hinders the positive and helps the negative direction: gravity, above all [N·m].
    """

    inertia: float
    friction: float
    viscous: float
    load: float = 0.0


def motion_of(pushes: list[Push], latency: float, resolution: float) -> Motion:
    """Fit inertia and sliding friction to some pushes, by the torque balance integrated twice.

    inertia · x = ∬ torque - (friction ± load) · ∬ 1 - viscous · ∫ x, from the first cycle of each push, in which
    the torque steps from 0, until the last count.

    Parameters
    ----------
    pushes : list of Push
    latency : float
        From sending a command until it acts [s].
    resolution : float
        [rad]
    """
    rows: list[npt.NDArray[np.float64]] = []
    wanted: list[npt.NDArray[np.float64]] = []
    for each in pushes:
        times, x, twice, moving = _integrated(each, latency, resolution)
        if moving < 3:
            continue
        inner = slice(1, moving + 1)
        elapsed = times[inner] - times[0]
        area = np.concatenate(((0.0,), np.cumsum(0.5 * (x[1:] + x[:-1]) * np.diff(times))))
        held = 0.5 * elapsed**2
        rows.append(np.stack((x[inner], held, area[inner], each.direction * held), axis=1))
        wanted.append(twice[inner])
    if not rows:
        return Motion(math.nan, math.nan, math.nan)
    matrix, target = np.concatenate(rows), np.concatenate(wanted)
    if len(matrix) < _UNKNOWN:
        return Motion(math.nan, math.nan, math.nan)
    scale = np.abs(matrix).max(axis=0)
    found, *_ = np.linalg.lstsq(matrix / np.where(scale > 0.0, scale, 1.0), target, rcond=1e-9)
    inertia, friction, viscous, load = (float(value) for value in found / scale)
    return Motion(inertia if inertia > 0.0 else math.nan, friction, viscous, load)


def _integrated(
    each: Push, latency: float, resolution: float
) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64], npt.NDArray[np.float64], int]:
    """Times since the torque stepped, way, torque integrated twice, and the last sample that moved."""
    trace = each.trace
    begin = trace.time[0] + latency
    times = np.concatenate(((begin,), trace.time[1:]))
    x = each.direction * (trace.position - trace.position[0])
    # The torque of a row acts from its own time plus the latency; between samples it is a step.
    torque = each.direction * trace.torque
    steps = np.diff(torque, prepend=0.0)
    acts = trace.time + latency
    late = np.clip(times[:, None] - acts[None, :], 0.0, None)
    twice = 0.5 * (late**2) @ steps
    moved = np.flatnonzero(np.abs(np.diff(x)) > 0.5 * resolution)
    last = int(moved[-1]) + 1 if len(moved) else 0
    return times, x, twice, min(last, len(x) - 1)


@dataclass(frozen=True, slots=True)
class SensorResponse:
    """How the torque sensor follows the joint's acceleration.

    Attributes
    ----------
    slope : float
        Of the reading over the acceleration [reading·s²/rad].
    error : float
        Its standard error.
    """

    slope: float
    error: float

    @property
    def significance(self) -> float:
        """Slope over its standard error; 0 where there is none."""
        return self.slope / self.error if self.error > 0.0 and math.isfinite(self.error) else 0.0


def sensor_response(
    pushes: list[Push], motion: Motion, latency: float, resolution: float
) -> SensorResponse:
    """Regress the sensor's readings on the acceleration, beside whatever they are at each position.

    The acceleration is that of the fitted motion: the encoder's second difference would be mostly counts.
    What a reading is at a position (ripple of the gear, weight of the link, zero) is a polynomial of it.
    """
    positions, readings, accelerations = [], [], []
    for each in pushes:
        times, x, _, moving = _integrated(each, latency, resolution)
        trace = each.trace
        sliding = np.zeros(len(times), dtype=bool)
        sliding[1 : moving + 1] = True
        acting = np.concatenate(((0.0,), each.direction * trace.torque[:-1]))
        speed = np.gradient(x, trace.time) if len(x) > 2 else np.zeros(len(x))
        against = motion.friction + each.direction * motion.load
        acceleration = (acting - against - motion.viscous * speed) / motion.inertia
        accelerations.append(each.direction * np.where(sliding, acceleration, 0.0))
        positions.append(trace.position)
        readings.append(trace.reading)
    position, reading, acceleration = (
        np.concatenate(parts) for parts in (positions, readings, accelerations)
    )
    if np.count_nonzero(acceleration) < _FEWEST or not math.isfinite(motion.inertia):
        return SensorResponse(0.0, math.inf)
    middle, width = position.mean(), max(np.ptp(position), resolution)
    shape = np.polynomial.chebyshev.chebvander(2.0 * (position - middle) / width, _DEGREE)
    matrix = np.column_stack((acceleration, shape))
    found, *_ = np.linalg.lstsq(matrix, reading, rcond=1e-10)
    left = reading - matrix @ found
    free = max(len(reading) - matrix.shape[1], 1)
    across, *_ = np.linalg.lstsq(shape, acceleration, rcond=1e-10)
    own = acceleration - shape @ across
    power = float(own @ own)
    if power <= 0.0:
        return SensorResponse(0.0, math.inf)
    return SensorResponse(float(found[0]), math.sqrt(float(left @ left) / free / power))
