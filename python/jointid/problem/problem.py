"""A problem: recordings, joint and terms, the penalty that they define, and its table of windows."""

from __future__ import annotations

import functools
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.base.errors import InputError
from jointid.base.values import dataclass
from jointid.joint.joint import Joint
from jointid.problem.own_integrals import known_torque, own_series
from jointid.problem.recordings import output_torque, raise_if_slowly_sampled
from jointid.problem.settings import USUAL, Settings
from jointid.problem.terms import TermChoice
from jointid.problem.window_table import WindowTable
from jointid.problem.windows import Windows, window_options
from jointid.recording.recording import Recording

Array = NDArray[np.float64]

Made = TypeVar("Made")

_HOLDS = {"zoh": _core.Hold.zero_order, "linear": _core.Hold.linear}


@dataclass(frozen=True, kw_only=True)
class Problem:
    """Recordings and the terms to identify from them; the windows are chosen later.

    Attributes
    ----------
    recordings : tuple of Recording
    joint : Joint or None
    choice : TermChoice
    settings : Settings
        Settings of the call, with the automatic choices filled in.
    threads : int
        Number of threads. 0 (default): all.
    """

    recordings: tuple[Recording, ...]
    joint: Joint | None
    choice: TermChoice
    settings: Settings = USUAL
    threads: int = 0

    def changed(self, **settings: Any) -> Problem:
        """Return the problem with some settings changed."""
        return replace(self, settings=replace(self.settings, **settings))

    @property
    def shift(self) -> Mapping[str, float]:
        """Delays that were removed from the signals [s]."""
        return self.settings.shift or {}

    @property
    def min_speed(self) -> float:
        """Speed below which motion is left out [rad/s or m/s]."""
        return self.settings.min_speed or 0.0

    def penalty(self, windows: Windows) -> _core.Penalty:
        """Return the penalty over these windows; an int is their number, a float their duration [s].

        Raises
        ------
        InputError
            The windows cannot be cut.
        """
        return self._cut(_core.Penalty, windows)

    def parts(self, windows: Windows, residual: str | None = None) -> _core.PenaltyParts:
        """Return the same penalty, summed part by part, for a caller that evaluates it only once or twice.

        Parameters
        ----------
        windows : int, float, str, WindowOptions or None
        residual : str, optional
            Residual to use. Default: that of the problem.

        Raises
        ------
        InputError
            The windows cannot be cut.
        """
        return self._cut(_core.PenaltyParts, windows, residual)

    def ripple(self, theta: Array, halves: int, period: float) -> tuple[int, float, Array]:
        """Compare the torque's residual with multiples of half the motor's angle, over windows of one period.

        Parameters
        ----------
        theta : ndarray, shape (p,)
        halves : int
            Number of multiples.
        period : float
            Duration of the windows [s].

        Returns
        -------
        windows : int
        power : float
            Sum of squared mean residuals.
        sums : ndarray, shape (halves,)
            Magnitude of the residuals' sum for each multiple.

        Raises
        ------
        InputError
            The windows cannot be cut.
        """
        # Without a first stage, "instruments" equals the torque's residual and needs no further sums.
        own = self.choice.residual
        made = functools.partial(_core.ripple, theta=theta, halves=halves)
        return self._cut(made, period, "torque" if own == "instruments" else own)

    def _cut(
        self, made: Callable[..., Made], windows: Windows, residual: str | None = None
    ) -> Made:
        options = self.window_options(windows)
        arguments = self.in_arguments  # its errors are already raised here
        try:
            return made(
                windows=options,
                residual=_core.Residual[residual or self.choice.residual],
                **arguments,
            )
        except InputError:
            raise_if_slowly_sampled(self.recordings)
            raise

    @property
    def peak_speed(self) -> float:
        """Largest speed in the recordings [rad/s or m/s]."""
        return max(
            [abs(end) for recording in self.recordings for end in recording.ranges["velocity"]]
        )

    def window_options(self, windows: Windows) -> _core.WindowOptions:
        """Convert the argument `windows` of a call to options for these recordings.

        Raises
        ------
        InputError
            The argument is neither a positive number nor "cumulative".
        """
        return window_options(windows, self.recordings)

    def table(
        self,
        penalty: _core.Penalty,
        theta: Array,
        known: tuple[Array, Array] | None = None,
    ) -> WindowTable:
        """Return the penalty's windows at a parameter vector; they are separate even if the penalty accumulates.

        Parameters
        ----------
        penalty : Penalty
        theta : ndarray, shape (p,)
        known : tuple of ndarray, optional
            Residuals and columns of the penalty at `theta`. Default: computed here.
        """
        if penalty.cumulative:
            apart = _core.WindowOptions(duration=penalty.window_duration)
            penalty, known = self.penalty(apart), None
        if known is None:
            known = penalty.residuals(theta), penalty.columns(theta[penalty.coefficients :])
        residual, columns = known
        names = penalty.names[: penalty.coefficients]
        bounds = penalty.windows
        run = np.array(penalty.recording_of)  # a copy, to free the penalty
        start = np.empty(len(run))
        stop = np.empty(len(run))
        travel = np.empty(len(run))
        for number, recording in enumerate(self.recordings):
            mine = slice(*np.searchsorted(run, (number, number + 1)))
            first, last = bounds[mine, 0], bounds[mine, 1]
            start[mine], stop[mine] = recording.time[first], recording.time[last]
            travel[mine] = recording.position[last] - recording.position[first]
        if self.choice.residual == "sensor":
            measured = columns[:, names.index("sensor_gain")].copy()
            fitted = measured + residual
            torque_residual = residual * theta[names.index("sensor_gain")]
        elif (
            self.choice.residual == "instruments"
        ):  # the gain is known: the torque is also known in terms of the reading
            measured = columns[:, names.index("sensor_gain")].copy()
            fitted = measured + residual / theta[names.index("sensor_gain")]
            torque_residual = residual
        else:
            measured = penalty.target.copy()
            fitted = measured - residual
            torque_residual = residual
        friction = torque_residual.copy()
        for index, term in enumerate(penalty.terms):
            if term.friction and not term.needs_load:  # the map is without load
                friction += theta[index] * columns[:, index]
        duration = penalty.usable_duration.copy()  # a copy: a view would keep the penalty in memory
        return WindowTable(
            recording=run,
            start=start,
            stop=stop,
            duration=duration,
            measured=measured,
            fitted=fitted,
            velocity=travel / (stop - start),
            friction=friction / duration,
        )

    @functools.cached_property
    def in_core(self) -> list[_core.Recording]:
        """Return the recordings for the core; they share the arrays, and each computes its mask once."""
        return [self._in_core(number) for number in range(len(self.recordings))]

    @property
    def in_arguments(self) -> dict[str, Any]:
        """Return the problem as arguments of the core's functions."""
        return {
            "recordings": self.in_core,
            "terms": list(self.choice.terms),
            "mask_standstill": self.settings.mask_standstill,
            "gear_ratio": self.choice.gear_ratio,
            "per_recording": list(self.choice.per_recording),
            "threads": self.threads,
        }

    @property
    def masked(self) -> tuple[list[_core.Recording], bool]:
        """Return the recordings for the core, and whether standstill is left out."""
        return self.in_core, self.settings.mask_standstill

    def usable(self, number: int) -> NDArray[np.uint8]:
        """Return for each interval between samples of a recording whether it is used."""
        recordings, standstill = self.masked
        return np.asarray(_core.usable_intervals(recordings[number], standstill))

    def hold(self, number: int) -> str:
        """Return the interpolation of a recording's torque between samples: "zoh" or "linear"."""
        hold: str | None = self.settings.torque_hold
        if hold is None:
            hold = self.recordings[number].torque_hold
        if hold is None:
            hold = (self.joint.torque_hold if self.joint is not None else None) or "linear"
        return hold

    @property
    def states_hold(self) -> bool:
        """Return whether the call, a recording or the joint states the torque's interpolation."""
        of_joint = self.joint is not None and self.joint.torque_hold is not None
        of_runs = any(run.torque_hold is not None for run in self.recordings)
        return self.settings.torque_hold is not None or of_joint or of_runs

    def output_torque(self, number: int) -> Array:
        """Return the drive's torque of a recording at the output [N·m or N]."""
        return output_torque(self.recordings[number], self.joint)

    def unexplained_torque(self, number: int) -> Array:
        """Return the output torque minus the known torques of own terms [N·m or N]."""
        torque = self.output_torque(number)
        known = known_torque(self.choice.model.resolved.terms, self.recordings[number])
        if known is None:
            return torque
        if self.hold(number) == "zoh":  # known torques change while the command is held
            known = np.append(0.5 * (known[1:] + known[:-1]), known[-1:])
        return np.asarray(torque - known)

    def _in_core(self, number: int) -> _core.Recording:
        recording = self.recordings[number]
        return _core.Recording(
            time=recording.time,
            position=recording.position,
            velocity=recording.velocity,
            torque=self.output_torque(number),
            sensor=recording.sensor if self.choice.sensor else None,
            torque_hold=_HOLDS[self.hold(number)],
            gap_after=[gap.index for gap in recording.gaps],
            min_speed=self.min_speed,
            doubtful=list(recording.doubtful),
            own=own_series(self.choice.model.resolved.terms, recording),
        )
