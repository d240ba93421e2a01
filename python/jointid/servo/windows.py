"""The torque balance of a servo over windows, with every column linear in what is sought.

Over a window, with the load's inertia and gravity known, without any acceleration:

    J_load dω + ∫ gravity = (k_t/R) ∫ u - (k_t²/R) ∫ ω_driven
                            - viscous ∫ ω - coulomb ∫ sgn ω - load ∫ sgn ω |gear| - J dω

where u is the voltage and gear = gravity + motor torque is what presses the teeth: motor and load pull from the two
sides. With the sign of gear held, its integral is linear in k_t/R and k_t²/R, too.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from jointid.base.values import dataclass
from jointid.joint.joint import Joint
from jointid.servo.signals import ServoSignals

Array = NDArray[np.float64]
Counts = NDArray[np.int64]

WINDOW = 0.05
"""Duration of a window by default [s]."""

SLOWEST = 0.1
"""Slower motion is left out: friction is not at its dry level there [rad/s]."""

_PIECES = 10  # grid steps of a window
_STRIDE = 2  # grid steps from a window to the next
_SPAN = 0.6  # of a window: over which the position's slope is taken
_FEWEST = 5  # samples in that span, at least

_REACH = int(0.5 * _SPAN * _PIECES)  # grid steps in half of that span

# Columns of the table.
VOLTAGE, DRIVEN, TURNED, SIGN, CHANGE, LOAD, LOAD_VOLTAGE, LOAD_DRIVEN, KNOWN = range(9)
COLUMNS = 9


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ServoGrid:
    """All runs on even grids, one after the other, and their windows.

    Attributes
    ----------
    velocity, voltage, gravity, driven, sign : ndarray, shape (n,)
        [rad/s], [V], [N·m], 0 or 1, sign of the velocity.
    step : ndarray, shape (n,)
        Of each instant's run [s].
    start, end : ndarray of int, shape (windows,)
        Instants of a window's ends.
    run : ndarray of int, shape (windows,)
    time : ndarray, shape (windows,)
        Of a window's start in its run [s].
    load_inertia : float
        [kg·m²]
    """

    velocity: Array
    voltage: Array
    gravity: Array
    driven: Array
    sign: Array
    step: Array
    start: Counts
    end: Counts
    run: Counts
    time: Array
    load_inertia: float

    def integrals(self, values: Array) -> Array:
        """Return the trapezoidal integral of a signal over each window."""
        pieces = 0.5 * (values[1:] + values[:-1]) * self.step[1:]
        sums = np.concatenate(([0.0], np.cumsum(pieces)))
        return np.asarray(sums[self.end] - sums[self.start])

    def gear_torque(self, torque_per_voltage: float, back_emf: float) -> Array:
        """Return what presses the teeth at each instant [N·m]."""
        motor = torque_per_voltage * self.voltage - back_emf * self.velocity * self.driven
        return np.asarray(self.gravity + motor)

    def table(self) -> Array:
        """Return all columns but those of the load's friction, shape (windows, COLUMNS)."""
        columns = np.zeros((len(self.start), COLUMNS))
        columns[:, VOLTAGE] = self.integrals(self.voltage)
        columns[:, DRIVEN] = self.integrals(self.velocity * self.driven)
        columns[:, TURNED] = self.integrals(self.velocity)
        columns[:, SIGN] = self.integrals(self.sign)
        columns[:, CHANGE] = self.velocity[self.end] - self.velocity[self.start]
        columns[:, KNOWN] = self.load_inertia * columns[:, CHANGE] + self.integrals(self.gravity)
        return columns

    def with_load(self, table: Array, torque_per_voltage: float, back_emf: float) -> Array:
        """Return the table with the load's friction, for the gear's torque of these values."""
        side = self.sign * np.sign(self.gear_torque(torque_per_voltage, back_emf))
        filled = table.copy()
        filled[:, LOAD] = self.integrals(side * self.gravity)
        filled[:, LOAD_VOLTAGE] = self.integrals(side * self.voltage)
        filled[:, LOAD_DRIVEN] = self.integrals(side * self.velocity * self.driven)
        return filled


def grid_of(
    runs: Sequence[ServoSignals],
    joint: Joint,
    *,
    window: float = WINDOW,
    slowest: float = SLOWEST,
    lead: float = 0.0,
) -> ServoGrid:
    """Return runs on even grids, with the windows that can be used.

    A window is used where the motor is driven throughout or not at all, and the velocity neither changes its sign nor
    falls below the slowest.

    Parameters
    ----------
    runs : sequence of ServoSignals
    joint : Joint
        Its link is the known load.
    window : float
        Duration [s]; longer where samples are rare. Default `WINDOW`.
    slowest : float
        [rad/s]. Default `SLOWEST`.
    lead : float
        Time by which a row's position is older than its duty [s]. Default 0.
    """
    parts, offset = [], 0
    for number, run in enumerate(runs):
        duration = max(window, _FEWEST * float(np.median(np.diff(run.time))) / _SPAN)
        part = _part(run, joint, duration, slowest, lead)
        part["run"] = np.full(len(part["start"]), number)
        part["start"], part["end"] = part["start"] + offset, part["end"] + offset
        offset += len(part["velocity"])
        parts.append(part)
    joined = {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}
    return ServoGrid(load_inertia=joint.link_inertia, **joined)


def _part(
    run: ServoSignals, joint: Joint, duration: float, slowest: float, lead: float
) -> dict[str, NDArray[np.float64] | Counts]:
    step, half = duration / _PIECES, 0.5 * _SPAN * duration
    count = max(0, int((run.time[-1] - run.time[0] - 2.0 * half) / step)) + 1
    times = run.time[0] + half + step * np.arange(count)
    position, velocity = local_quadratic(run.time, run.position, times, half)
    driven = run.driven[np.searchsorted(run.time, times, side="right") - 1]
    # A row's duty was read after its position, so it belongs to a later time.
    voltage = np.interp(times, run.time + lead, run.duty * run.supply) * driven
    if joint.link is None:
        gravity = np.zeros(count)
    else:
        weight = joint.gravity_coefficients
        gravity = weight.cos * np.cos(position) + weight.sin * np.sin(position)
    # The slope of a span is a weighted mean of the velocity; what stands beside it is taken as the same mean.
    voltage, gravity = smoothed(voltage), smoothed(gravity)
    start = np.arange(_REACH, max(_REACH, count - _PIECES - _REACH), _STRIDE)
    inside = start[:, None] + np.arange(_PIECES + 1)
    around = start[:, None] + np.arange(-_REACH, _PIECES + _REACH + 1)
    usable = (
        (np.abs(velocity[inside]).min(axis=1) >= slowest)
        & (np.ptp(np.sign(velocity)[inside], axis=1) == 0.0)
        & (np.ptp(driven[around], axis=1) == 0.0)
    )
    start = start[usable]
    # No integral crosses from one run to the next: the first piece of a run has no length.
    steps = np.full(count, step)
    steps[0] = 0.0
    return {
        "velocity": velocity,
        "voltage": voltage,
        "gravity": gravity,
        "driven": driven,
        "sign": np.sign(velocity),
        "step": steps,
        "start": start,
        "end": start + _PIECES,
        "time": times[start] - run.time[0],
    }


def smoothed(values: Array) -> Array:
    """Return a signal as the mean over the span that the slope of a parabola takes of a velocity.

    The slope over a half span h weighs the velocity at a distance x by 1 - (x / h)².

    Parameters
    ----------
    values : ndarray, shape (n,)
        On the even grid; its first and last are continued.
    """
    x = np.arange(-_REACH, _REACH + 1) / _REACH
    weights = 1.0 - x * x
    padded = np.pad(values, _REACH, mode="edge")
    return np.convolve(padded, weights / weights.sum(), mode="valid")


def local_quadratic(time: Array, values: Array, at: Array, half: float) -> tuple[Array, Array]:
    """Return value and slope of parabolas through the samples within a half span of each instant.

    The logged velocity of a servo lags by tens of milliseconds; the slope of its position does not.

    Parameters
    ----------
    time, values : ndarray, shape (n,)
    at : ndarray, shape (m,)
    half : float
        [s]
    """
    first = np.searchsorted(time, at - half - 1e-9)
    last = np.searchsorted(time, at + half + 1e-9)
    widest = int((last - first).max())
    index = first[:, None] + np.arange(widest)
    inside = index < last[:, None]
    index = np.minimum(index, len(time) - 1)
    x = np.where(inside, (time[index] - at[:, None]) / half, 0.0)
    y = np.where(inside, values[index], 0.0)
    powers = [inside.sum(axis=1).astype(float)]
    moments = [y.sum(axis=1)]
    raised = np.where(inside, 1.0, 0.0)
    for order in range(1, 5):
        raised = raised * x
        powers.append(raised.sum(axis=1))
        if order < 3:
            moments.append((raised * y).sum(axis=1))
    matrix = np.stack(
        [np.stack([powers[i + j] for j in range(3)], axis=-1) for i in range(3)], axis=-2
    )
    # Three different instants fix a parabola; where a gap leaves fewer, the span has no slope.
    poor = powers[0] < 4
    matrix[poor] = np.eye(3)
    found = np.linalg.solve(matrix, np.stack(moments, axis=-1)[..., None])[..., 0]
    found[poor] = 0.0
    return found[:, 0], found[:, 1] / half
