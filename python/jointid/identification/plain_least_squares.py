"""Cross-check of an estimate by plain least squares on the filtered recorded signals.

The cross-check does not use the masks, windows, velocities, delays or unwrapping of the identification. It takes only
the shape of the Stribeck term from the estimate.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.base.values import dataclass
from jointid.estimate.cross_check import CrossCheck, SecondValue
from jointid.estimate.statistics import ParameterEstimate
from jointid.problem.problem import Problem
from jointid.problem.recordings import output_torque
from jointid.recording.order_statistics import median, quantile_of_sizes
from jointid.recording.recording import Recording

Array = NDArray[np.float64]

_CUTOFF = 20.0  # Hz
_BLOCK = 0.005  # s: faster samples are first averaged over blocks of this length
_SHORTEST = 24  # blocks in the shortest stretch
_PASSES = 4  # moving averages; an even number has no phase
_BAND = 0.225  # cutoff of these passes times their width
_SETTINGS = ((1.0, 1.0), (0.5, 1.0), (1.0, 1.5))  # factors on the cutoff and on the lowest speed
_FAST = 2.2  # speed times the root of the Stribeck shape; above it the Stribeck term is below 1 %
_SPEED, _MOST_SPEED = 0.15, 0.5  # lowest speed and its upper limit, as shares of the peak speed
_PEAK = 0.995  # quantile of the speeds that counts as the peak speed
_JUMP, _ALONE = 20.0, 5.0  # a jump over the usual position step, and over both neighboring steps
_STEP, _STEPS = 0.0025, 12  # s; delays of at most 12 steps are tried
_WORTH = 0.8  # a delay is used if it reduces the residual below this share
_BLOCKS = 20
_ROWS = 10  # smallest number of rows per unknown
_SINGULAR = 1e-8
_CLEAR = 5.0  # standard errors
# Allowed difference: this share of the value, plus this number of combined standard errors.
_SHARE, _ERRORS = 0.05, 3.0
_GRAVITY = ("gravity_cos", "gravity_sin")
_OFFSETS = ("torque_offset", "sensor_offset")
_TORQUE = "N·m"
_SEEN = 1e-6  # share of a friction term's largest value; below it the rows do not contain the term


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class _Stretch:
    """Stretch of the signals without gap or jump, averaged over short blocks.

    Attributes
    ----------
    run : int
        Index of the recording.
    signals : ndarray, shape (4 or 5, n)
        Time, position, torque, sensor, and the velocity if it is recorded.
    period : float
        Time between blocks [s].
    """

    run: int
    signals: Array
    period: float

    def smoothed(self, cutoff: float) -> tuple[Array, int]:
        """Return the low-passed signals without phase, and the width of the moving averages."""
        width = max(2, round(_BAND / (cutoff * self.period)))
        values = self.signals
        for _ in range(_PASSES):
            total = np.cumsum(values, axis=1)
            total[:, width:] -= total[:, :-width].copy()
            values = total[:, width - 1 :] / width
        return values, width


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class _Rows:
    """Filtered signals of all recordings at the kept rows, and each whole stretch."""

    run: NDArray[np.intp]
    time: Array
    position: Array
    velocity: Array
    acceleration: Array
    torque: Array
    sensor: Array
    smooth: tuple[tuple[Array, Array, Array, slice], ...]


def second_look(
    given: Sequence[Recording],
    problem: Problem,
    penalty: _core.Penalty,
    parameters: Mapping[str, ParameterEstimate],
) -> CrossCheck:
    """Return the cross-check of an estimate.

    Parameters
    ----------
    given : sequence of Recording
        Recordings of the call, without corrections.
    problem : Problem
    penalty : Penalty
    parameters : mapping of str to ParameterEstimate
    """
    terms = penalty.terms
    names, others = penalty.names[: len(terms)], penalty.names[len(terms) :]
    lacking = [term.name for term in terms if term.own]
    lacking += ["load_friction"] if problem.choice.model.resolved.load_friction else []
    if lacking:
        return CrossCheck(reason=f"plain least squares has no term {lacking[0]}")
    shapes = {name: parameters[name].value for name in others}
    free = [name for name in names if parameters[name].vary]
    friction = [
        name
        for name, term in zip(names, terms, strict=True)
        if term.friction and term.unit == _TORQUE
    ]
    stretches = _stretches(given, problem)
    looks: list[tuple[dict[str, float], dict[str, float], float]] = []
    found: dict[str, SecondValue] = {}
    for cutoff, speed in _SETTINGS:
        rows = _rows_of(stretches, cutoff * _CUTOFF, speed, shapes)
        if rows is None or len(rows.time) < max(2 * _BLOCKS, _ROWS * len(free)):
            if not looks:
                return CrossCheck(reason="too little steady motion in one direction")
            continue
        delay = looks[0][2] if looks else None
        looks.append(_fitted(rows, problem, terms, names, parameters, shapes, delay))
        values, errors, delay = looks[0]
        for name, value in values.items():
            if name.partition("[")[0] not in _compared(terms):
                continue
            every = [each[0][name] for each in looks if name in each[0]]
            scale = _scale(parameters[name], friction, parameters)
            found[name] = _compared_with(
                parameters[name], value, errors[name], max(every) - min(every), scale
            )
        if all(each.agrees for each in found.values()):
            break  # another setting can only explain a difference
    if not found:
        return CrossCheck(reason="the steady motion determines no parameter")
    return CrossCheck(values=found, delay=looks[0][2])


def _compared_with(
    p: ParameterEstimate, value: float, stderr: float, spread: float, scale: float
) -> SecondValue:
    allowed = _SHARE * scale + spread
    allowed += _ERRORS * math.hypot(stderr, p.uncertainty if p.vary else 0.0)
    # The cross-check has no bounds, so a friction of 0 is often slightly negative there.
    within = min(max(value, p.min), p.max)
    agrees = not abs(within - p.shown_value) > allowed
    return SecondValue(value=value, stderr=stderr, spread=spread, agrees=agrees)


def _compared(terms: Sequence[_core.Term]) -> set[str]:
    """Return the parameters that the cross-check may contradict; static friction and ripple are not among them."""
    plain = {"inertia", "sensor_gain", *_GRAVITY, *_OFFSETS}
    return plain | {term.name for term in terms if term.friction and not term.shapes}


def _scale(
    p: ParameterEstimate,
    friction: Sequence[str],
    parameters: Mapping[str, ParameterEstimate],
) -> float:
    """Return the reference of the allowed 5 %: the value, or for offset and gravity also a larger dry friction."""
    if p.name.partition("[")[0] not in (*_GRAVITY, *_OFFSETS):
        return abs(p.value)
    return max(abs(parameters[name].value) for name in (p.name, *friction))


def _stretches(given: Sequence[Recording], problem: Problem) -> list[_Stretch]:
    found = []
    for number, run in enumerate(given):
        torque = output_torque(run, problem.joint)
        if problem.hold(number) == "zoh":  # the previous sample's command is held until this sample
            torque = 0.5 * (torque + np.concatenate([torque[:1], torque[:-1]]))
        sensed = run.sensor if problem.choice.sensor and run.sensor is not None else 0.0 * torque
        signals = [run.time, run.position, torque, sensed]
        if not run.velocity_derived:
            signals.append(run.velocity)
        block = max(1, int(_BLOCK / run.sample_period))
        cuts = sorted({0, len(run), *(gap.index + 1 for gap in run.gaps), *_jumps(run.position)})
        for begin, end in pairwise(cuts):
            count = (end - begin) // block
            if count < _SHORTEST:
                continue
            rows = np.array([each[begin : begin + count * block] for each in signals])
            means = rows.reshape(len(signals), count, block) @ np.full(block, 1.0 / block)
            found.append(_Stretch(run=number, signals=means, period=block * run.sample_period))
    return found


def _rows_of(
    stretches: Sequence[_Stretch], cutoff: float, speed: float, shapes: Mapping[str, float]
) -> _Rows | None:
    """Return the rows of fast motion in one direction; `speed` is a factor on the lowest speed."""
    found = []
    for stretch in stretches:
        (time, position, torque, sensor, *recorded), width = stretch.smoothed(cutoff)
        if len(time) > 4 * width + 1:
            velocity = recorded[0] if recorded else np.gradient(position, time)
            found.append((stretch.run, width, time, position, velocity, torque, sensor))
    if not found:
        return None
    peak = quantile_of_sizes(np.concatenate([each[4] for each in found]), _PEAK)
    stribeck = [value for name, value in shapes.items() if name.startswith("stribeck")]
    least = _SPEED * peak
    if stribeck and min(stribeck) > 0.0:
        least = min(_FAST / float(np.sqrt(min(stribeck))), _MOST_SPEED * peak)
    parts, smooth, count = [], [], 0
    for number, width, time, position, velocity, torque, sensor in found:
        reach = 2 * width
        # Near a reversal the filter mixes both directions.
        signs = np.convolve(np.sign(velocity), np.ones(2 * reach + 1), "same")
        kept = np.flatnonzero((np.abs(velocity) > speed * least) & (np.abs(signs) > 2 * reach))
        kept = kept[kept % width == 0]
        rate = np.gradient(velocity, time)
        parts.append(
            (
                np.full(len(kept), number),
                *(each[kept] for each in (time, position, velocity, rate, torque, sensor)),
            )
        )
        smooth.append((time, torque, sensor, slice(count, count + len(kept))))
        count += len(kept)
    run, time, position, velocity, acceleration, torque, sensor = (
        np.concatenate(each) for each in zip(*parts, strict=True)
    )
    return _Rows(
        run=run,
        time=time,
        position=position,
        velocity=velocity,
        acceleration=acceleration,
        torque=torque,
        sensor=sensor,
        smooth=tuple(smooth),
    )


def _jumps(position: Array) -> list[int]:
    """Return the rows where the position jumps: a step much larger than usual and than both neighboring steps."""
    steps = np.abs(np.diff(position))
    moved = np.flatnonzero(steps)
    if len(moved) < 3:
        return []
    size = steps[moved]
    around = np.maximum(np.append(size[1:], 0.0), np.concatenate([[0.0], size[:-1]]))
    jump = (size > _JUMP * median(size)) & (size > _ALONE * around)
    return [int(each) + 1 for each in moved[jump]]


def _fitted(
    rows: _Rows,
    problem: Problem,
    terms: Sequence[_core.Term],
    names: Sequence[str],
    parameters: Mapping[str, ParameterEstimate],
    shapes: Mapping[str, float],
    delay: float | None,
) -> tuple[dict[str, float], dict[str, float], float]:
    """Return values, standard errors and delay of one setting."""
    columns: dict[str, Array] = {}
    known = np.zeros(len(rows.time))
    for term, name in zip(terms, names, strict=True):
        column = _column(term, name, rows, shapes, problem.choice.gear_ratio)
        if not parameters[name].vary:
            known = known + parameters[name].value * column
        elif np.abs(column).max() > _SEEN * bool(term.shapes):
            columns[name] = column
    sensed = "sensor_gain" in columns
    gain = columns.pop("sensor_gain", None)
    order = list(columns)
    regressors = np.column_stack([*columns.values(), *([] if gain is None else [rows.torque])])
    if gain is None:
        signal, less = 1, known
    else:
        signal, less = 2, np.zeros(len(rows.time))
        regressors[:, -1] -= known
    delay = _best_delay(rows, regressors, signal, less) if delay is None else delay
    target = _shifted(rows, signal, np.array([delay]))[:, 0] - less
    solved, stderr, determined = _solved(regressors, target)
    if sensed:
        return *_of_reading(order, solved, determined), delay
    fits = dict(zip(order, solved[0], strict=True))
    errors = dict(zip(order, stderr, strict=True))
    return (
        {name: float(fits[name]) for name, sure in zip(order, determined, strict=True) if sure},
        {name: float(each) for name, each in errors.items()},
        delay,
    )


def _of_reading(
    order: Sequence[str], solved: Array, determined: NDArray[np.bool_]
) -> tuple[dict[str, float], dict[str, float]]:
    """Return the parameters from a regression of the reading, where the coefficient of the torque is 1 / gain."""
    factor = solved[:, -1]
    if not determined[-1] or not abs(factor[0]) > _CLEAR * _jackknife(factor[:, None])[0]:
        return {}, {}  # the reading does not follow the torque
    every = np.column_stack([-solved[:, :-1] / factor[:, None], 1.0 / factor])
    errors = _jackknife(every)
    names = [*order, "sensor_gain"]
    sure = [*determined[:-1], True]
    return (
        {name: float(v) for name, v, ok in zip(names, every[0], sure, strict=True) if ok},
        {name: float(error) for name, error in zip(names, errors, strict=True)},
    )


def _column(
    term: _core.Term, name: str, rows: _Rows, shapes: Mapping[str, float], gear_ratio: float
) -> Array:
    """Return the regressor of a coefficient at each row."""
    base = term.name
    if base == "inertia":
        column = rows.acceleration
    elif base == "sensor_gain":
        column = rows.sensor
    elif term.friction:
        shape = np.array([shapes[each] for each in term.shapes])
        column = np.asarray(_core.friction_basis(term.key, rows.velocity, shape))
    elif base in _OFFSETS:
        column = np.ones(len(rows.time))
    elif base in _GRAVITY:
        column = (np.cos if base == "gravity_cos" else np.sin)(rows.position)
    else:  # ripple_cos_2: order 2 of the motor's angle; position_sin_1: order 1 of the joint's angle
        kind, wave, order = re.fullmatch(r"(\w+?)_(cos|sin)_([\d.e+-]+)", term.key).groups()  # type: ignore[union-attr]
        angle = float(order) * rows.position * (gear_ratio if kind == "ripple" else 1.0)
        column = (np.cos if wave == "cos" else np.sin)(angle)
    own = re.search(r"\[(\d+)\]$", name)
    return column if own is None else np.where(rows.run == int(own[1]), column, 0.0)


def _shifted(rows: _Rows, signal: int, delays: Array) -> Array:
    """Return the torque (1) or the reading (2) at the rows' times plus each delay; shape (rows, delays)."""
    target = np.empty((len(rows.time), len(delays)))
    for time, torque, sensor, here in rows.smooth:
        values = torque if signal == 1 else sensor
        target[here] = np.interp(rows.time[here, None] + delays, time, values)
    return target


def _best_delay(rows: _Rows, regressors: Array, signal: int, less: Array) -> float:
    """Return the delay of the target that clearly reduces the residual, or 0."""
    basis = np.linalg.qr(regressors)[0]
    grid: Array = _STEP * np.arange(-_STEPS, _STEPS + 1, dtype=np.float64)
    targets = _shifted(rows, signal, grid) - less[:, None]
    sizes = np.linalg.norm(targets - basis @ (basis.T @ targets), axis=0)
    best = int(np.argmin(sizes))
    return float(grid[best]) if sizes[best] < _WORTH * sizes[_STEPS] else 0.0


def _solved(regressors: Array, target: Array) -> tuple[Array, Array, NDArray[np.bool_]]:
    """Return least-squares values of all rows, then without each block; their errors; which values are determined."""
    size = np.linalg.norm(regressors, axis=0)
    scale = np.where(size > 0.0, size, 1.0)
    both = np.column_stack([regressors / scale, target])
    edges = np.linspace(0, len(target), _BLOCKS + 1).astype(int)
    parts = np.array([both[a:b].T @ both[a:b] for a, b in pairwise(edges)])
    total = parts.sum(axis=0)
    sums = np.concatenate([total[None], total - parts])
    power, directions = np.linalg.eigh(total[:-1, :-1])
    vague = directions[:, power < _SINGULAR * power[-1]]
    determined = np.square(vague).sum(axis=1) < 1e-6
    inverse = np.linalg.pinv(sums[:, :-1, :-1], rcond=_SINGULAR, hermitian=True)
    values = np.einsum("bij,bj->bi", inverse, sums[:, :-1, -1]) / scale
    return values, _jackknife(values), determined


def _jackknife(values: Array) -> Array:
    """Return standard errors by the jackknife: row 0 has the values of all data, the others lack one block each."""
    without = values[1:]
    away = without - without.mean(axis=0)
    return np.asarray(np.sqrt((len(without) - 1) / len(without) * np.square(away).sum(axis=0)))
