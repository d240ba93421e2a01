"""Short pushes just above breakaway: they show the inertia and the torque sensor's sign in a fraction of a degree."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt

from jointid.hardware.proof.axis import Axis, Trace
from jointid.hardware.proof.refusal import RefusedBenchError

Array = npt.NDArray[np.float64]

STRENGTH = 1.15  # torque of a push over the breakaway in its direction
_LONGEST = 0.4  # [s], longest push
_DEGREE = 5  # degree of the polynomial of the sensor's readings over position
_UNKNOWN = 8  # fewest rows for four unknowns
_FEWEST = 50  # fewest samples in motion for a result
_MANY = 40.0  # counts of a push; more means a fine encoder
_INFORMED = 4000.0  # squared counts of all pushes that are enough for the inertia


@dataclass(frozen=True)
class Push:
    """One push, from its first cycle until the joint is at rest, positive in its own direction.

    Computed values are cached, because the drive waits for the host's next command between two pushes.

    Attributes
    ----------
    trace : Trace
    direction : float
        1 or -1.
    latency : float
        Delay from sending a command until it acts [s].
    resolution : float
        Output angle of an encoder count [rad].
    """

    trace: Trace
    direction: float
    latency: float
    resolution: float

    @property
    def width(self) -> float:
        """Distance of the push [rad]."""
        return float(np.ptp(self.trace.position))

    @property
    def counts(self) -> float:
        """Distance of the push in encoder counts."""
        return self.width / self.resolution

    @property
    def fastest(self) -> float:
        """Highest speed between two samples, minus the count that rounding adds [rad/s]."""
        steps = np.abs(np.diff(self.trace.position)) - self.resolution
        return float((steps / np.diff(self.trace.time)).max(initial=0.0))

    @cached_property
    def times(self) -> Array:
        """Times of the torque's steps, and times of the samples [s]."""
        return np.concatenate(((self.trace.time[0] + self.latency,), self.trace.time[1:]))

    @cached_property
    def way(self) -> Array:
        """Distance from the start in the direction of the push [rad]."""
        gone: Array = self.trace.position - self.trace.position[0]
        return self.direction * gone

    @cached_property
    def moving(self) -> int:
        """Index of the last sample in motion."""
        moved = np.flatnonzero(np.abs(np.diff(self.way)) > 0.5 * self.resolution)
        return int(moved[-1]) + 1 if len(moved) else 0

    @cached_property
    def balance(self) -> Array:
        """Twice integrated terms of the balance during motion: those of inertia and torque, and the others."""
        inner, times, way = slice(1, self.moving + 1), self.times, self.way
        # The torque of a row acts from its own time plus the latency. It changes in few rows.
        steps = np.diff(self.direction * self.trace.torque, prepend=0.0)
        some = np.flatnonzero(steps)
        late = times[inner, None] - (self.trace.time[some] + self.latency)
        twice = 0.5 * np.clip(late, 0.0, None) ** 2 @ steps[some]
        area = np.concatenate(((0.0,), np.cumsum(0.5 * (way[1:] + way[:-1]) * np.diff(times))))
        held = 0.5 * (times[inner] - times[0]) ** 2
        return np.stack((way[inner], twice, held, area[inner], self.direction * held), axis=1)

    def acceleration(self, motion: Motion) -> Array:
        """Return the acceleration of the fitted motion, positive in the joint's direction; 0 at rest [rad/s²]."""
        acting = np.concatenate(((0.0,), self.direction * self.trace.torque[:-1]))
        speed = np.gradient(self.way, self.trace.time) if len(self.way) > 2 else 0.0 * self.way
        against = motion.friction + self.direction * motion.load
        found = (acting - against - motion.viscous * speed) / motion.inertia
        found[0] = 0.0
        found[self.moving + 1 :] = 0.0
        return self.direction * found


def push(axis: Axis, direction: float, torque: float, reach: float) -> Push:
    """Push until the joint has moved by `reach` [rad], then let it come to rest at zero torque.

    Raises
    ------
    RefusedBenchError
        A bound of the axis is exceeded, or nothing moved.
    """
    begin = len(axis.rows)
    place, end = axis.sample.position, axis.now + _LONGEST
    while abs(axis.read().position - place) < reach and axis.now < end:
        axis.command(direction * torque)
    axis.rest()
    if max(abs(row[1] - place) for row in axis.rows[begin:]) < 1.5 * axis.resolution:
        raise RefusedBenchError(
            "encoder_stands",
            f"{direction * torque:.4g} N·m did not move the joint, but less torque moved it before: the encoder "
            "hangs or is disconnected, or something blocks the joint",
        )
    return Push(axis.trace(begin), direction, axis.latency, axis.resolution)


@dataclass(frozen=True, slots=True)
class Motion:
    """Values of the joint from pushes, by the joint file's constants.

    Attributes
    ----------
    inertia : float
        Inertia [kg·m²]; NaN if it cannot be identified.
    friction, viscous : float
        Sliding friction [N·m] and viscous coefficient [N·m·s/rad].
    load : float
        Load that opposes the positive direction, mainly gravity [N·m].
    """

    inertia: float
    friction: float
    viscous: float
    load: float = 0.0


def informed(pushes: list[Push]) -> bool:
    """Return whether the encoder counts are enough to identify the inertia."""
    return sum(each.counts**2 for each in pushes) > _INFORMED


def motion_of(pushes: list[Push]) -> Motion:
    """Fit inertia and sliding friction to some pushes, by the torque balance integrated twice.

    inertia · x = ∬ torque - (friction ± load) · ∬ 1 - viscous · ∫ x, from the first cycle of each push, in which
    the torque steps from 0, until the last count. For a coarse encoder, x is fitted by the torque. The inverse fit
    would make the inertia too small, because of the rounding to counts. The mean of x is subtracted then, because the
    start position within a count is not known.
    """
    moved = [each for each in pushes if each.moving > 2]
    coarse = all(each.counts < _MANY for each in moved)
    balances = [each.balance - coarse * each.balance.mean(axis=0) for each in moved]
    terms = np.concatenate(balances) if balances else np.zeros((0, 5))
    if len(terms) < _UNKNOWN:
        return Motion(math.nan, math.nan, math.nan)
    way, twice, others = terms[:, 0], terms[:, 1], terms[:, 2:]
    left, right = (twice, way) if coarse else (way, twice)
    matrix = np.column_stack((left, others))
    scale = np.abs(matrix).max(axis=0)
    solved, *_ = np.linalg.lstsq(matrix / np.where(scale > 0.0, scale, 1.0), right, rcond=1e-9)
    first, *rest = (float(value) for value in solved / scale)
    if not first > 0.0:
        return Motion(math.nan, math.nan, math.nan)
    if coarse:
        first, rest = 1.0 / first, [-each / first for each in rest]
    return Motion(first, *rest)


@dataclass(frozen=True, slots=True)
class SensorResponse:
    """Response of the torque sensor to the joint's acceleration.

    Attributes
    ----------
    slope : float
        Slope of the reading over the acceleration [reading·s²/rad].
    error : float
        Standard error of the slope.
    """

    slope: float
    error: float

    @property
    def significance(self) -> float:
        """Slope over its standard error; 0 without one."""
        return self.slope / self.error if self.error > 0.0 and math.isfinite(self.error) else 0.0


def sensor_response(pushes: list[Push], motion: Motion) -> SensorResponse:
    """Regress the sensor's readings on the acceleration and on a polynomial of the position.

    The acceleration is that of the fitted motion, because the second difference of the encoder is mostly noise of the
    counts. The polynomial contains all that depends on position: ripple of the gear, weight of the link, zero.
    """
    if not math.isfinite(motion.inertia):
        return SensorResponse(0.0, math.inf)
    position = np.concatenate([each.trace.position for each in pushes])
    reading = np.concatenate([each.trace.reading for each in pushes])
    acceleration = np.concatenate([each.acceleration(motion) for each in pushes])
    if np.count_nonzero(acceleration) < _FEWEST:
        return SensorResponse(0.0, math.inf)
    middle, width = position.mean(), max(np.ptp(position), pushes[0].resolution)
    shape = np.polynomial.chebyshev.chebvander(2.0 * (position - middle) / width, _DEGREE)
    # The normal equations are fast, and the drive waits for the next command; the 7 columns are well scaled.
    gram = shape.T @ shape
    own = acceleration - shape @ np.linalg.lstsq(gram, shape.T @ acceleration, rcond=1e-10)[0]
    left = reading - reading.mean()
    left = left - shape @ np.linalg.lstsq(gram, shape.T @ left, rcond=1e-10)[0]
    power = float(own @ own)
    if power <= 0.0:
        return SensorResponse(0.0, math.inf)
    slope = float(own @ left) / power
    left = left - slope * own
    free = max(len(reading) - _DEGREE - 2, 1)
    return SensorResponse(slope, math.sqrt(float(left @ left) / free / power))
