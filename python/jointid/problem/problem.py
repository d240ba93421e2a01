"""Recordings, joint and terms put together: the penalty they define, and its windows in numbers."""

from __future__ import annotations

import functools
import numbers
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.base.errors import InputError
from jointid.joint.joint import Joint
from jointid.problem.terms import TermChoice
from jointid.problem.window_table import WindowTable
from jointid.recording.recording import Recording

Array = NDArray[np.float64]

Windows = int | float | str | _core.WindowOptions | None

Made = TypeVar("Made", _core.Penalty, _core.PenaltyParts)

_MOST_GAPS = 0.1  # of the intervals; beyond, the median period is not the period

_HOLDS = {"zoh": _core.Hold.zero_order, "linear": _core.Hold.linear}


@dataclass(frozen=True, kw_only=True)
class Problem:
    """What is identified from what; how finely it is cut into windows is left open.

    Attributes
    ----------
    recordings : tuple of Recording
    joint : Joint or None
    choice : TermChoice
    torque_hold : str or None
        Overrides what recording and joint say.
    mask_standstill : bool
    """

    recordings: tuple[Recording, ...]
    joint: Joint | None
    choice: TermChoice
    torque_hold: str | None
    mask_standstill: bool
    threads: int = 0

    def penalty(self, windows: Windows) -> _core.Penalty:
        """The penalty over these windows: an int is their number, a float their duration [s].

        Raises
        ------
        InputError
            Windows that cannot be cut.
        """
        return self._cut(_core.Penalty, windows)

    def parts(self, windows: Windows) -> _core.PenaltyParts:
        """The same, summed part by part: for what needs its windows once or twice.

        Raises
        ------
        InputError
            Windows that cannot be cut.
        """
        return self._cut(_core.PenaltyParts, windows)

    def _cut(self, made: type[Made], windows: Windows) -> Made:
        options = self.window_options(windows)
        try:
            return made(
                recordings=self.in_core,
                terms=list(self.choice.terms),
                windows=options,
                residual=_core.Residual[self.choice.residual],
                mask_standstill=self.mask_standstill,
                gear_ratio=self.choice.gear_ratio,
                per_recording=list(self.choice.per_recording),
                threads=self.threads,
            )
        except ValueError as error:
            raise InputError(str(error)) from error

    @property
    def peak_speed(self) -> float:
        """Largest speed in the recordings [rad/s or m/s]."""
        return max(float(np.abs(recording.velocity).max()) for recording in self.recordings)

    def window_options(self, windows: Windows) -> _core.WindowOptions:
        """The call's `windows=` as options for these recordings.

        Raises
        ------
        InputError
            Not a positive number, nor "cumulative".
        """
        if isinstance(windows, str):
            if windows != "cumulative":
                raise InputError(
                    f"windows '{windows}' is not known; use a number, a duration or 'cumulative'"
                )
            period = min(recording.sample_period for recording in self.recordings)
            return _core.WindowOptions(duration=period, cumulative=True)
        return _options(windows)

    def table(
        self,
        penalty: _core.Penalty,
        theta: Array,
        known: tuple[Array, Array] | None = None,
    ) -> WindowTable:
        """The penalty's windows at a parameter vector; each for itself even if the penalty accumulates.

        `known` are its residuals and columns there, if somebody has them.
        """
        if penalty.cumulative:
            apart = _core.WindowOptions(duration=penalty.window_duration)
            penalty, known = self.penalty(apart), None
        if known is None:
            known = penalty.residuals(theta), penalty.columns(theta[penalty.coefficients :])
        residual, columns = known
        names = penalty.names[: penalty.coefficients]
        bounds = penalty.windows
        run = np.asarray(penalty.recording_of, dtype=np.int64)
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
        else:
            measured = penalty.target.copy()
            fitted = measured - residual
            torque_residual = residual
        friction = torque_residual.copy()
        for index, term in enumerate(penalty.terms):
            if term.friction and not term.needs_load:  # the friction map is drawn without load
                friction += theta[index] * columns[:, index]
        duration = penalty.usable_duration.copy()  # a view would keep the penalty for good
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
        """The recordings as the core takes them: their arrays, not copies; each finds its mask once."""
        return [self._in_core(recording) for recording in self.recordings]

    def _in_core(self, recording: Recording) -> _core.Recording:
        hold = self.torque_hold or recording.torque_hold
        if hold is None:
            hold = (self.joint.torque_hold if self.joint is not None else None) or "linear"
        if hold not in _HOLDS:
            raise InputError(f"torque_hold '{hold}' is not known; known are {', '.join(_HOLDS)}")
        return _core.Recording(
            time=recording.time,
            position=recording.position,
            velocity=recording.velocity,
            torque=output_torque(recording, self.joint),
            sensor=recording.sensor if self.choice.sensor else None,
            torque_hold=_HOLDS[hold],
            gap_after=[gap.index for gap in recording.gaps],
        )


def output_torque(recording: Recording, joint: Joint | None) -> Array:
    """The drive's torque at the output [N·m or N].

    Raises
    ------
    InputError
        The recording has none, or only one on the motor side and no joint to turn it round.
    """
    if joint is not None:
        return joint.output_torque(recording)
    if recording.torque is not None:
        return recording.torque
    for signal, needs in (
        ("motor_torque", "gear_ratio"),
        ("current", "torque_constant and gear_ratio"),
    ):
        if getattr(recording, signal) is not None:
            raise InputError(
                f"the recording has '{signal}' on the motor side; give a joint with {needs} to turn it into torque"
            )
    raise InputError("the recording has no signal 'torque'; map it with columns={'torque': ...}")


def _options(windows: int | float | _core.WindowOptions | None) -> _core.WindowOptions:
    if windows is None:
        return _core.WindowOptions()
    if isinstance(windows, _core.WindowOptions):
        return windows
    if isinstance(windows, bool | str) or not isinstance(windows, numbers.Real):
        raise InputError(
            "windows must be a number (int), a duration in seconds (float), 'cumulative' or WindowOptions, got "
            f"{windows!r}"
        )
    if not 0 < windows < 1e15:
        raise InputError(f"windows must be positive and finite, got {windows!r}")
    if isinstance(windows, numbers.Integral):
        return _core.WindowOptions(count=int(windows))
    return _core.WindowOptions(duration=float(windows))


def listed(recordings: Recording | Sequence[Recording]) -> tuple[Recording, ...]:
    """One recording or several, checked.

    Raises
    ------
    InputError
        None, something else, or revolute and prismatic mixed.
    """
    if isinstance(recordings, Recording):
        recordings = (recordings,)
    if not isinstance(recordings, Iterable) or isinstance(recordings, str):
        raise InputError(
            f"recordings is a {type(recordings).__name__}, not a Recording; read a file with jointid.load"
        )
    runs = tuple(recordings)
    if not runs:
        raise InputError("identify needs at least one recording, got none")
    for number, run in enumerate(runs):
        if not isinstance(run, Recording):
            raise InputError(
                f"recording {number} is a {type(run).__name__}, not a Recording; read a file with jointid.load"
            )
        if len(run.gaps) > _MOST_GAPS * len(run):
            raise InputError(
                f"recording {number}: {100 * len(run.gaps) / len(run):.0f} % of its sample intervals are gaps, as when "
                "a bus hands over samples in bursts; take the drive's time stamps, not the host's, or a uniform clock"
            )
        if run.kind != runs[0].kind:
            raise InputError(
                f"recording {number} is {run.kind}, recording 0 is {runs[0].kind}; identify them apart"
            )
    return runs
