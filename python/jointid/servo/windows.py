"""Torque balance of a servo over windows, with every column linear in the unknowns.

The balance over a window, without any acceleration; the load's inertia and gravity are known:

    J_load dω + ∫ gravity = (k_t/R) ∫ u - (k_t²/R) ∫ ω_driven
                            - Σ friction_i ∫ sgn ω h_i(|ω|) - load ∫ sgn ω |gear| - J dω

Here h_i is the basis of a term in the core's table, and u is the voltage. gear = gravity + motor torque is the load of
the teeth, because motor and load push from opposite sides. If the sign of gear is fixed, its integral is also linear in
k_t/R and k_t²/R. The log does not show the command between rows, so u = even + held · late. Here late is the addition
for a command that is held until the next row.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.base.values import dataclass
from jointid.joint.joint import Joint
from jointid.servo.between_rows import voltages
from jointid.servo.layout import BACK_EMF, CHANGE, HELD, KNOWN, LOAD, TORQUE
from jointid.servo.motion import local_quadratic, smoothed
from jointid.servo.signals import ServoSignals

Array = NDArray[np.float64]
Counts = NDArray[np.int64]

WINDOW = 0.05
"""Default duration of a window [s]."""

SLOWEST = 0.1
"""Slower motion is left out, because friction has not reached its dry level there [rad/s]."""

_PIECES = 10  # grid steps in a window
_STRIDE = 2  # grid steps from a window to the next
_SPAN = 0.6  # share of a window that gives the position's slope
_FEWEST = 5  # smallest number of samples in that span

_REACH = int(0.5 * _SPAN * _PIECES)  # grid steps in half of that span


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ServoGrid:
    """All runs on even grids, one after the other (n instants), and their windows."""

    position: Array  # (n,) [rad]
    velocity: Array  # (n,) [rad/s]
    voltage: Array  # (n,) [V]
    late: Array  # (n,) [V], addition for a held command
    gravity: Array  # (n,) [N·m]
    driven: Array  # (n,), 0 or 1
    sign: Array  # (n,), sign of the velocity
    friction: Array  # (terms, n), friction of the speed with a coefficient of 1
    instants: tuple[Array, ...]  # instants of each run [s]
    step: Array  # (n,), grid step of each instant's run [s]
    start: Counts  # (windows,), first instant
    end: Counts  # (windows,), last instant
    run: Counts  # (windows,), number of the run
    time: Array  # (windows,), start in the window's run [s]
    load_inertia: float  # [kg·m²]
    columns: Array  # (windows, columns), with zeros for the load's friction

    def integrals(self, *signals: Array) -> Array:
        """Return the trapezoidal integrals of signals over each window, shape (windows, signals)."""
        windows = np.column_stack((self.start, self.end))
        return _core.window_integrals(np.column_stack(signals), self.step[1:], windows)

    def with_columns(self) -> ServoGrid:
        """Return the grid with its table computed from its signals."""
        driven = self.velocity * self.driven
        found = self.integrals(self.voltage, self.late, driven, *self.friction, self.gravity)
        columns = np.zeros((len(self.start), found.shape[1] + 5))
        columns[:, :CHANGE] = found[:, :-1]
        columns[:, CHANGE] = self.velocity[self.end] - self.velocity[self.start]
        columns[:, KNOWN] = found[:, -1] + self.load_inertia * columns[:, CHANGE]
        return replace(self, columns=columns)

    def side(self, values: Array) -> Array:
        """Return the sign of the gear's torque relative to the motion (-1, 0 or 1), at these parameter values."""
        volts = self.voltage + values[HELD] * self.late
        motor = values[TORQUE] * volts - values[BACK_EMF] * self.velocity * self.driven
        return np.asarray(self.sign * np.sign(self.gravity + motor))

    def with_load(self, side: Array) -> Array:
        """Return the table with the load's friction, for these signs of the gear's torque."""
        filled = self.columns.copy()
        signals = (self.gravity, self.voltage, self.late, self.velocity * self.driven)
        filled[:, LOAD:] = self.integrals(*(side * each for each in signals))
        return filled

    def with_lead(self, runs: Sequence[ServoSignals], joint: Joint, lead: float) -> ServoGrid:
        """Return the grid of the same runs with another lead of the rows [s]; its windows stay."""
        pairs = [
            _voltages(run, joint, at, lead) for run, at in zip(runs, self.instants, strict=True)
        ]
        voltage, late = (np.concatenate(each) for each in zip(*pairs, strict=True))
        return replace(self, voltage=voltage, late=late).with_columns()


def grid_of(
    runs: Sequence[ServoSignals],
    joint: Joint,
    friction: Sequence[_core.Term],
    *,
    window: float = WINDOW,
    slowest: float = SLOWEST,
    lead: float = 0.0,
) -> ServoGrid:
    """Return runs on even grids, with the windows that can be used.

    A window is used if the motor is driven in all of it or in none of it, and if the velocity neither changes its sign
    nor falls below `slowest` [rad/s]. `window` is its duration [s]; it is longer if samples are rare. `lead` is the
    time by which a row's position is older than its duty [s].
    """
    parts, instants, offset = [], [], 0
    for number, run in enumerate(runs):
        duration = max(window, _FEWEST * float(np.median(np.diff(run.time))) / _SPAN)
        times, part = _part(run, joint, duration, slowest, lead)
        part["run"] = np.full(len(part["start"]), number)
        part["start"], part["end"] = part["start"] + offset, part["end"] + offset
        offset += len(times)
        parts.append(part)
        instants.append(times)
    joined = {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}
    velocity, none = joined["velocity"], np.empty(0)  # no shapes
    return ServoGrid(
        friction=np.stack([_core.friction_basis(t.key, velocity, none) for t in friction]),
        load_inertia=joint.link_inertia,
        instants=tuple(instants),
        columns=np.zeros((0, 0)),
        **joined,
    ).with_columns()


def _part(
    run: ServoSignals, joint: Joint, duration: float, slowest: float, lead: float
) -> tuple[Array, dict[str, NDArray[np.float64] | Counts]]:
    step, half = duration / _PIECES, 0.5 * _SPAN * duration
    count = max(0, int((run.time[-1] - run.time[0] - 2.0 * half) / step)) + 1
    times = run.time[0] + half + step * np.arange(count)
    position, velocity = local_quadratic(run.time, run.position, times, half)
    voltage, late = _voltages(run, joint, times, lead)
    driven = run.driven_at(times)
    if joint.link is None:
        gravity = np.zeros(count)
    else:
        weight = joint.gravity_coefficients
        gravity = weight.cos * np.cos(position) + weight.sin * np.sin(position)
    start = np.arange(_REACH, max(_REACH, count - _PIECES - _REACH), _STRIDE)
    # Counts of what a window must not contain, up to each instant: slow motion, a reversal, switching.
    sign = np.sign(velocity)
    slow = _upto(np.abs(velocity) < slowest)
    turns, switches = _upto(sign[1:] != sign[:-1]), _upto(driven[1:] != driven[:-1])
    end = start + _PIECES
    usable = (
        (slow[end + 1] == slow[start])
        & (turns[end] == turns[start])
        & (switches[end + _REACH] == switches[start - _REACH])
    )
    start = start[usable]
    # No integral crosses from one run to the next, because the first piece of a run has no length.
    steps = np.full(count, step)
    steps[0] = 0.0
    return times, {
        "position": position,
        "velocity": velocity,
        "voltage": voltage,
        "late": late,
        # The slope of a span is a weighted mean of the velocity; gravity is averaged with the same weights.
        "gravity": smoothed(gravity, _REACH),
        "driven": driven,
        "sign": sign,
        "step": steps,
        "start": start,
        "end": start + _PIECES,
        "time": times[start] - run.time[0],
    }


def _voltages(run: ServoSignals, joint: Joint, times: Array, lead: float) -> tuple[Array, Array]:
    even, late = voltages(run, joint.voltage, times, lead)
    return smoothed(even, _REACH), smoothed(late, _REACH) if late.any() else late


def _upto(marks: NDArray[np.bool_]) -> Counts:
    """Return the number of marks before each instant, and in total."""
    return np.concatenate((np.zeros(1, dtype=np.int64), np.cumsum(marks)))
