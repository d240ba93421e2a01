"""Simulated recordings with known parameters: the recorded motion with the torque that these parameters need."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.base.values import dataclass
from jointid.identification.inference.systematic import held
from jointid.identification.self_test.signal_noise import SignalNoise
from jointid.problem.problem import Problem
from jointid.problem.recordings import output_torque
from jointid.problem.window_table import WindowTable
from jointid.problem.windows import Windows
from jointid.recording.recording import Recording

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True)
class _Run:
    """True signals of one recording, and the noise to add to them."""

    true: Recording
    position: SignalNoise
    velocity: SignalNoise | None
    sensor: SignalNoise | None
    residual: Array
    durations: Array
    starts: Array


class Injection:
    """Simulator of recordings with known parameters, from the motion and noise of real recordings.

    Parameters
    ----------
    problem : Problem
        Problem of the recordings.
    windows : int, float, str, WindowOptions or None
        Windows of the estimate.
    names : sequence of str
        Names of the parameters, in the penalty's order.
    theta : ndarray, shape (p,)
        Estimated values of the parameters.
    table : WindowTable
        Windows of the estimate. Their residuals are the part of the torque that the model lacks.
    rng : Generator
        Random generator of the noise in a trial without disturbance.
    """

    def __init__(
        self,
        problem: Problem,
        windows: Windows,
        names: Sequence[str],
        theta: Array,
        table: WindowTable,
        rng: np.random.Generator,
    ) -> None:
        self._problem, self._names, self._theta = problem, tuple(names), theta
        self._runs = [
            self._run(number, recording, table)
            for number, recording in enumerate(problem.recordings)
        ]
        true = replace(
            problem,
            recordings=tuple(run.true for run in self._runs),
            choice=replace(problem.choice, residual="torque"),
        )
        period = min(recording.sample_period for recording in problem.recordings)
        self._fine = true.penalty(_core.WindowOptions(duration=period))
        shapes = self._fine.columns(theta[self._fine.coefficients :])
        self._reading = [
            index
            for index, term in enumerate(self._fine.terms)
            if term.name in ("sensor_gain", "sensor_offset")
        ]
        # The torque at the sensor does not depend on the sensor's parameters.
        self._sensed = np.einsum("ij,j->i", shapes[:, self._reading], theta[self._reading])
        # Noise of position, velocity and sensor explains part of the residuals; the torque gets the rest.
        self._share = 0.0
        trial = replace(problem, recordings=self.recordings(theta, rng))
        quiet = trial.table(trial.penalty(windows), theta)
        explained = float(np.mean(np.square(quiet.residual)))
        whole = float(np.mean(np.square(table.residual)))
        if whole > explained:
            self._share = float(np.sqrt(1.0 - explained / whole))

    def _run(self, number: int, recording: Recording, table: WindowTable) -> _Run:
        mine = table.recording == number
        position = SignalNoise.of(recording.position)
        velocity = None if recording.velocity_derived else SignalNoise.of(recording.velocity)
        sensor = None
        reading = recording.sensor if self._problem.choice.sensor else None
        if reading is not None:
            sensor = SignalNoise.of(reading)
            reading = sensor.removed(reading)
        true = Recording(
            time=recording.time,
            position=position.removed(recording.position),
            torque=output_torque(recording, self._problem.joint),
            sensor=reading,
            extra=recording.extra,
            kind=recording.kind,
            torque_hold=recording.torque_hold,
            name=recording.name,
        )
        residual = table.residual[mine]
        gain = self._value("sensor_gain", number) if sensor is not None else 1.0
        if self._problem.choice.residual != "torque":  # the table is in terms of the reading
            residual = residual * gain
        return _Run(
            true=true,
            position=position,
            velocity=velocity,
            sensor=sensor,
            residual=residual,
            durations=table.duration[mine],
            starts=table.start[mine],
        )

    def _value(self, name: str, number: int, theta: Array | None = None) -> float:
        values = self._theta if theta is None else theta
        own = f"{name}[{number}]"
        for each in (own, name):
            if each in self._names:
                return float(values[self._names.index(each)])
        return 0.0

    def recordings(self, theta: Array, rng: np.random.Generator) -> tuple[Recording, ...]:
        """Return simulated recordings with these parameters.

        Parameters
        ----------
        theta : ndarray, shape (p,)
            Parameters in the order of the names.
        rng : Generator
            Random generator of the noise.
        """
        fine = self._fine
        columns = fine.columns(theta[fine.coefficients :])
        columns[:, self._reading] = 0.0
        needed = np.einsum("ij,j->i", columns, theta[: fine.coefficients]) + self._sensed
        bounds, run_of = fine.windows, np.asarray(fine.recording_of)
        made = []
        for number, run in enumerate(self._runs):
            mine = run_of == number
            torque = self._torque(run, bounds[mine], needed[mine])
            torque += self._share * _drawn(run, rng)
            made.append(self._recorded(run, torque, theta, number, rng))
        return tuple(made)

    def sizes(self, theta: Array) -> Array:
        """Return the relative change of the torque for one unit of each parameter; infinite for shapes."""
        columns = self._fine.columns(theta[self._fine.coefficients :])
        level = float(
            np.sqrt(
                np.sum(np.square(np.einsum("ij,j->i", columns, theta[: self._fine.coefficients])))
            )
        )
        sizes = np.full(len(theta), np.inf)
        if level > 0.0:
            sizes[: self._fine.coefficients] = np.sqrt(np.square(columns).sum(axis=0)) / level
        return sizes

    def _torque(self, run: _Run, bounds: NDArray[np.int64], needed: Array) -> Array:
        """Return a torque at the samples with these integrals; outside them, the recorded torque."""
        time, recorded = run.true.time, run.true.torque
        assert recorded is not None
        mean_of = np.full(time.size, np.nan)
        mean = needed / (time[bounds[:, 1]] - time[bounds[:, 0]])
        lengths = bounds[:, 1] - bounds[:, 0]
        mean_of[np.repeat(bounds[:, 0], lengths) + _counted(lengths)] = np.repeat(mean, lengths)
        if not held(self._problem, run.true):  # linear between samples: the mean of both sides
            before = np.concatenate([[np.nan], mean_of[:-1]])
            both = np.isnan(before) + 0.0 + np.isnan(mean_of)
            total = np.nan_to_num(before) + np.nan_to_num(mean_of)
            mean_of = np.where(both < 2.0, total / np.maximum(2.0 - both, 1.0), np.nan)
        return np.where(np.isnan(mean_of), recorded, mean_of)

    def _moving(self, number: int) -> NDArray[np.bool_]:
        """Return which samples of a recording the model covers."""
        bounds = self._fine.windows[np.asarray(self._fine.recording_of) == number]
        steps = np.zeros(len(self._problem.recordings[number]) + 1)
        np.add.at(steps, bounds[:, 0], 1.0)
        np.add.at(steps, bounds[:, 1] + 1, -1.0)
        return np.cumsum(steps)[:-1] > 0.0

    def _recorded(
        self, run: _Run, torque: Array, theta: Array, number: int, rng: np.random.Generator
    ) -> Recording:
        """Return the true signals with noise, as a recording."""
        true, recorded = run.true, self._problem.recordings[number]
        # At standstill, even the smallest noise would look like motion.
        moving = self._moving(number)
        position = np.where(moving, run.position.added(true.position, rng), recorded.position)
        velocity = None
        if run.velocity is not None:
            velocity = np.where(moving, run.velocity.added(true.velocity, rng), recorded.velocity)
        reading = None
        if run.sensor is not None and true.sensor is not None:
            loaded = self._value("sensor_gain", number) * true.sensor
            loaded += self._value("sensor_offset", number)
            reading = loaded - self._value("sensor_offset", number, theta)
            reading = run.sensor.added(reading / self._value("sensor_gain", number, theta), rng)
        return Recording(
            time=true.time,
            position=position,
            velocity=velocity,
            torque=torque,
            sensor=reading,
            extra=true.extra,
            kind=true.kind,
            torque_hold=true.torque_hold,
            name=true.name,
        )


def _counted(lengths: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return 0, 1, … for each length."""
    ends = np.cumsum(lengths)
    return np.arange(int(ends[-1]) if ends.size else 0) - np.repeat(ends - lengths, lengths)


def _drawn(run: _Run, rng: np.random.Generator) -> Array:
    """Return a disturbance torque at the samples: blocks of the residuals in random order with random signs."""
    count = run.residual.size
    length = max(1, round(np.sqrt(count)))
    blocks = -(-count // length)
    first = rng.integers(0, count, blocks)
    sign = rng.choice((-1.0, 1.0), blocks)
    rows = (first[:, None] + np.arange(length)) % count
    mean = (sign[:, None] * (run.residual / run.durations)[rows]).ravel()[:count]
    window = np.searchsorted(run.starts, run.true.time, side="right") - 1
    return np.asarray(mean[np.maximum(window, 0)])
