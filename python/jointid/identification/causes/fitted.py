"""Fitted balance of one joint, from a problem and its penalty."""

from __future__ import annotations

import functools
from collections.abc import Callable, Mapping, Sequence
from dataclasses import field, replace
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.base.advice import Action
from jointid.base.values import dataclass
from jointid.identification.causes.fitted_balance import FILTERED, FittedBalance
from jointid.identification.causes.folds import BLOCKS, first_windows
from jointid.identification.causes.late_signals import by_velocity, friction_at, rate
from jointid.identification.causes.samples import Samples, window_blocks
from jointid.problem.problem import Problem
from jointid.problem.recordings import output_torque, recording_names
from jointid.recording.order_statistics import distinct
from jointid.recording.recording import Recording

Array = NDArray[np.float64]

_OFTEN = 0.005  # smallest share of the samples at a limit
_EQUAL = 1e-9  # share of the torque's range
_MOST_RESTING = 0.5
_STRETCH = 1024  # windows; a multiple of the largest sum


@dataclass(frozen=True, kw_only=True)
class Fitted(FittedBalance):
    """Fitted balance at a minimum of the penalty.

    The residual is a torque. The derivative by the sensor gain uses the reading that the motion explains, so that noise
    of the reading has no effect.

    Attributes
    ----------
    problem : Problem
    penalty : Penalty
    chosen : ndarray of int, or None
        Indices of the penalty's windows to use; None: all.
    beside : Fitted, optional
        Another fit of the same recordings; its integration times are shared, because they need one value per sample.
    signals : mapping of str to ndarray
        Further signals of the first recording, one value per sample.
    prompt : frozenset of str
        Signals that are known to have no delay.
    filtered : bool
        Whether the velocity was late relative to the position, so that it may be filtered.
    """

    problem: Problem
    penalty: _core.Penalty
    chosen: NDArray[np.int64] | None = None
    beside: Fitted | None = None
    signals: Mapping[str, Array] = field(default_factory=dict)
    prompt: frozenset[str] = frozenset()
    filtered: bool = False

    @functools.cached_property
    def names(self) -> tuple[str, ...]:
        """Names of all parameters."""
        return tuple(self.penalty.names)

    @functools.cached_property
    def run(self) -> NDArray[np.int64]:
        """Index of each window's recording."""
        return self._every_run[self._firsts]

    @functools.cached_property
    def neighbours(self) -> NDArray[np.int64]:
        """Index of each window's group of neighbors: its recording, or its stretch of a recording."""
        if self.chosen is None:
            return self.run
        ends = (np.diff(self.chosen) != 1) | (np.diff(self.run) != 0)
        return np.concatenate([[0], np.cumsum(ends)])

    @functools.cached_property
    def spans(self) -> Array:
        """Start and end time of each window [s], shape (windows, 2)."""
        every = self._windows
        last = np.append(self._firsts[1:], len(every)) - 1
        found = np.column_stack([every[self._firsts, 0], every[last, 1]])
        times = np.empty(found.shape)
        for number, recording in enumerate(self.problem.recordings):
            here = self.run == number
            times[here] = recording.time[found[here]]
        return times

    @functools.cached_property
    def terms(self) -> Sequence[_core.Term]:
        """Terms of the penalty."""
        return tuple(self.penalty.terms)

    @property
    def window_duration(self) -> float:
        """Duration of the penalty's windows [s]."""
        return float(self.penalty.window_duration)

    @property
    def runs(self) -> Sequence[Recording]:
        """Recordings of the problem."""
        return self.problem.recordings

    @property
    def run_names(self) -> Sequence[str]:
        """Names of the recordings."""
        return recording_names(self.problem.recordings)

    @property
    def kind(self) -> Literal["revolute", "prismatic"]:
        """Kind of the joint."""
        return self.problem.recordings[0].kind

    @property
    def gear_ratio(self) -> float:
        """Absolute gear ratio of the joint; 1 without a joint."""
        joint = self.problem.joint
        return abs(joint.gear_ratio) if joint is not None else 1.0

    @property
    def further_signals(self) -> Mapping[str, Array]:
        """Further signals, and the temperature."""
        signals, first = dict(self.signals), self.problem.recordings[0]
        if len(self.problem.recordings) == 1 and first.temperature is not None:
            signals.setdefault("temperature", first.temperature)
        return signals

    @property
    def sample_period(self) -> float:
        """Sample period of the first recording [s]."""
        return self.problem.recordings[0].sample_period

    @property
    def torque_held(self) -> bool:
        """Whether the torque is held between samples."""
        return self.problem.hold(0) == "zoh"

    @property
    def model_name(self) -> str:
        """Name of the resolved friction model."""
        return str(self.problem.choice.model.resolved.name)

    @property
    def orders(self) -> Mapping[str, tuple[float, ...]]:
        """Orders of harmonics and ripple in the resolved model."""
        model = self.problem.choice.model.resolved
        return {"harmonics": model.harmonics, "ripple": model.ripple}

    def identified_with(self, **changes: Any) -> tuple[Action, ...]:
        """Return a call of `identify` with these fields of the model; the other fields stay as set."""
        return (Action("call", {"model": str(self.problem.choice.model.replace(**changes))}),)

    def compared_with(self, **changes: Any) -> tuple[Action, ...]:
        """Return a call that compares the model with a changed one."""
        model = self.problem.choice.model
        models = (str(model), str(model.replace(**changes)))
        return (Action("call", {"models": models}, function="compare_models"),)

    def late(self, signal: str) -> Array | None:
        """Return the change of the residual by a delay of torque, sensor or velocity, or by a velocity filter."""
        recorded = not self.problem.recordings[0].velocity_derived
        if signal == FILTERED and self.filtered and recorded:
            inertia = self.value("inertia")
            rise = inertia * self.rise(lambda _, run: rate(run) - run.velocity)
            torque = self.integral(
                lambda _, run: friction_at(self, rate(run)) - friction_at(self, run.velocity)
            )
            return rise + torque
        if signal in self.prompt:
            return None
        if signal == "torque":
            return -self.summed(self.penalty.torque_steps(*self.problem.masked))
        if signal == "sensor" and "sensor_gain" in self.names:
            gain = self.value("sensor_gain")
            return gain * self.rise(lambda _, run: np.asarray(run.sensor))
        if signal == "velocity" and recorded:
            return self.rise(lambda _, run: by_velocity(self, run))
        return None

    def summed(self, values: Array) -> Array:
        """Return sums of the values of the penalty's windows over the windows of this fit."""
        return self._grouped(self._of_chosen(np.asarray(values)))

    def _of_chosen(self, values: NDArray[Any]) -> NDArray[Any]:
        return values if self.chosen is None else values[self.chosen]

    def _grouped(self, values: Array) -> Array:
        return values if self.group == 1 else np.add.reduceat(values, self._firsts, axis=0)

    @functools.cached_property
    def _windows(self) -> NDArray[np.int64]:
        """First and last sample of the used windows of the penalty."""
        return self._of_chosen(np.asarray(self.penalty.windows, dtype=np.int64))

    @functools.cached_property
    def _every_run(self) -> NDArray[np.int64]:
        return self._of_chosen(np.asarray(self.penalty.recording_of, dtype=np.int64))

    @functools.cached_property
    def _firsts(self) -> NDArray[np.int64]:
        return first_windows(self._every_run, self.group)

    @functools.cached_property
    def columns(self) -> Array:
        """Integrals of the coefficients' terms, shape (windows, coefficients)."""
        return self.summed(self.penalty.columns(self.best[self.penalty.coefficients :]))

    @functools.cached_property
    def duration(self) -> Array:
        """Integrated time of each window [s]."""
        return self.summed(self.penalty.usable_duration)

    @functools.cached_property
    def trusted(self) -> NDArray[np.bool_]:
        """Windows without saturated torque, because a saturated record may be smaller than the torque.

        All windows count if most would be lost.
        """
        joint = self.problem.joint
        limited = [_on_a_limit(output_torque(run, joint)) for run in self.problem.recordings]
        resting = (
            self.integral_of_each(lambda number, run: limited[number][run.cut].astype(np.float64))
            > 0.0
        )
        return ~resting if resting.mean() < _MOST_RESTING else np.ones(len(resting), dtype=bool)

    @functools.cached_property
    def weights(self) -> list[Array]:
        """Integration time of each sample interval of each recording; 0 for unused intervals [s]."""
        if self.beside is not None:
            return self.beside.weights
        problem = self.problem
        return [
            np.diff(recording.time) * problem.usable(number).astype(np.float64)
            for number, recording in enumerate(problem.recordings)
        ]

    def errors_beside(self, torque: Array) -> dict[str, float]:
        """Return the errors of the values that a further torque adds.

        The torque is not noise: neighboring windows share it. Therefore its sums over blocks of time count.

        Parameters
        ----------
        torque : ndarray, shape (windows,)
            Integrals of the torque.
        """
        steps = self.solve(self.jacobian, torque) - self.start
        beside = torque + self.jacobian @ steps
        size = np.sqrt(np.einsum("ij,ij->j", self.jacobian, self.jacobian))
        size = np.where(size > 0.0, size, 1.0)
        scaled = self.jacobian / size
        square = np.einsum("ni,nj->ij", scaled, scaled) + 1e-12 * np.eye(len(size))
        first = distinct(np.linspace(0, len(beside), BLOCKS + 1).astype(int)[:-1])
        sums = np.add.reduceat(scaled * beside[:, None], first, axis=0)
        errors = np.sqrt(np.sum(np.linalg.solve(square, sums.T) ** 2, axis=1)) / size
        return {self.names[k]: float(e) for k, e in zip(self.free, errors, strict=True)}

    def integral(self, signal: Callable[[int, Recording], Array]) -> Array:
        """Return the integral over each window of a signal with shape (samples,) or (samples, m)."""
        return self._by_window(signal, rise=False)

    def rise(self, signal: Callable[[int, Recording], Array]) -> Array:
        """Return the rise of a signal over the integrated part of each window."""
        return self._by_window(signal, rise=True)

    def integral_of_each(self, signal: Callable[[int, Samples], Array]) -> Array:
        """Return the same as `integral`, computed from blocks of samples."""
        return self._by_samples(signal, rise=False)

    def rise_of_each(self, signal: Callable[[int, Samples], Array]) -> Array:
        """Return the same as `rise`, computed from blocks of samples."""
        return self._by_samples(signal, rise=True)

    @classmethod
    def of(
        cls,
        problem: Problem,
        penalty: _core.Penalty,
        best: Array,
        free: tuple[int, ...],
        signals: Mapping[str, Array] | None = None,
        prompt: frozenset[str] = frozenset(),
        filtered: bool = False,
        most: int | None = None,
        given: frozenset[str] = frozenset(),
        beside: Fitted | None = None,
    ) -> Fitted:
        """Return the fit at a minimum; its residual is a torque for any residual of the penalty.

        Parameters
        ----------
        most : int, optional
            Largest number of windows. Default: no limit.
        beside : Fitted, optional
            Fit of the whole recordings. If set, the fit uses stretches of single windows. Default: the fit sums
            neighboring windows.
        """
        _, residual, jacobian = penalty.linearised(best)
        jacobian = np.array(jacobian[:, list(free)])
        names = list(penalty.names)
        gain = names.index("sensor_gain") if "sensor_gain" in names else None
        if gain is not None and penalty.residual == _core.Residual.sensor:
            residual, jacobian = residual * best[gain], jacobian * best[gain]
        count = len(residual)
        sums = 1 if most is None else -(-count // most)
        fit = cls(
            problem=problem,
            penalty=penalty,
            best=best,
            free=free,
            residual=residual,
            jacobian=jacobian,
            start=np.zeros(len(free)),
            chosen=_stretches(count, most) if beside is not None and most is not None else None,
            group=max(1, sums) if beside is None else 1,
            beside=beside,
            signals=signals or {},
            prompt=prompt,
            filtered=filtered,
            given=given,
        )
        fit = replace(fit, residual=fit.summed(residual), jacobian=fit.summed(jacobian))
        jacobian = fit.jacobian
        if gain is None:
            return fit
        if gain not in free or "load_friction" in names:
            return fit
        place, reading = free.index(gain), fit.columns[:, gain]
        # Noise in the reading would bias the least squares, so the derivative uses the explained reading.
        jacobian[:, place] = -_explained(fit, reading)
        start = fit.solve(jacobian, fit.residual)
        actual = jacobian.copy()
        actual[:, place] = -reading
        return replace(fit, residual=fit.residual + actual @ start, start=start)

    def _by_samples(self, signal: Callable[[int, Samples], Array], *, rise: bool) -> Array:
        parts = []
        for number, recording in enumerate(self.problem.recordings):
            bounds, weights = self._own_bounds(number), self.weights[number]
            for windows, cut in window_blocks(bounds):
                values = np.asarray(signal(number, Samples.of(recording, cut)), dtype=np.float64)
                own = weights[cut.start : cut.stop - 1]
                each = _core.window_integrals(values, own, bounds[windows] - cut.start, rise=rise)
                parts.append(each[:, 0] if values.ndim == 1 else each)
        return self._grouped(np.concatenate(parts))

    def _own_bounds(self, number: int) -> NDArray[np.int64]:
        """Return first and last sample of the used windows of one recording."""
        mine = slice(*np.searchsorted(self._every_run, (number, number + 1)))
        return self._windows[mine]

    def _by_window(self, signal: Callable[[int, Recording], Array], *, rise: bool) -> Array:
        parts = []
        for number, recording in enumerate(self.problem.recordings):
            values = np.asarray(signal(number, recording), dtype=np.float64)
            weights = self.weights[number]
            each = _core.window_integrals(values, weights, self._own_bounds(number), rise=rise)
            parts.append(each[:, 0] if values.ndim == 1 else each)
        return self._grouped(np.concatenate(parts))


def _stretches(count: int, most: int) -> NDArray[np.int64]:
    """Return the indices of `most` of `count` windows, in stretches of neighbors at even distances."""
    length = min(most, _STRETCH)
    first = np.linspace(0, count - length, most // length).astype(np.int64)
    return np.asarray((first[:, None] + np.arange(length)).ravel())


def _on_a_limit(torque: Array) -> NDArray[np.bool_]:
    """Return which samples of the torque are saturated: equal to the largest or smallest value, if that is frequent."""
    resting = np.zeros(len(torque), dtype=bool)
    lowest, highest = float(torque.min()), float(torque.max())
    near = _EQUAL * (highest - lowest)
    for there in (torque >= highest - near, torque <= lowest + near):
        if there.mean() > _OFTEN:
            resting |= there
    return resting


def _explained(fit: Fitted, reading: Array) -> Array:
    """Return the part of the reading that the motion of a rigid link explains: acceleration, gravity and offset."""
    motion = [fit.rise_of_each(lambda _, run: run.velocity), fit.duration]
    if fit.kind == "revolute":
        motion += [
            fit.integral_of_each(lambda _, run: np.cos(run.position)),
            fit.integral_of_each(lambda _, run: np.sin(run.position)),
        ]
    columns = np.column_stack(motion)
    size = np.sqrt(np.einsum("ij,ij->j", columns, columns))
    columns /= np.where(size > 0.0, size, 1.0)
    square = np.einsum("ni,nj->ij", columns, columns) + 1e-12 * np.eye(columns.shape[1])
    found = np.linalg.solve(square, np.einsum("ni,n->i", columns, reading))
    return np.asarray(columns @ found)
