"""`OnlineIdentifier`: estimates from arriving samples, computed on a separate thread."""

from __future__ import annotations

import threading
import weakref
from collections.abc import Callable, Mapping
from types import TracebackType
from typing import Self, Unpack

import numpy as np
from numpy.typing import ArrayLike, NDArray

from jointid.base.errors import InputError
from jointid.base.options import checked as checked_options
from jointid.base.options import takes
from jointid.joint.checks import suggestion
from jointid.joint.joint import Joint
from jointid.online.online_estimate import OnlineEstimate
from jointid.online.options import OnlineOptions
from jointid.online.samples import checked
from jointid.online.settings import OnlineSettings
from jointid.online.worker import Worker
from jointid.problem.settings import Settings

Array = NDArray[np.float64]

_OPTIONAL = ("velocity", "sensor", "motor_torque", "current")


@takes(OnlineOptions)
class OnlineIdentifier:
    """Identify a joint while it runs, from the last seconds of its motion.

    `feed` accepts samples and returns at once. A thread processes the samples piece by piece, and removes samples
    older than `window`. After each piece, the thread computes a new estimate. An update takes a few milliseconds at
    any sampling rate. Integration windows and bounds are chosen as in `identify`. They are checked while the first
    `window` fills, and then once per `window`. An integration window has at least five samples. Below about 50
    samples per second, the default `window` of 30 s contains few integration windows. The estimate is then less
    accurate near reversals. The sensor gain is identified by regression: `residual` is "sensor" (default with a
    sensor) or "torque".

    `close`, or the end of a `with` block, ends the thread. Deleting the identifier also ends the thread, unless the
    callback refers to the identifier.

    Parameters
    ----------
    joint : Joint, optional
        Joint with known values, bounds and model, as for `identify`. Unknown bounds are computed from the first
        seconds. They are computed again if a parameter reaches such a bound.
    window : float
        Duration of the samples that an estimate uses [s]. Default 30.
    update : float
        Time between estimates, and duration of a piece of samples [s]. It is rounded up to a whole number of
        integration windows. Default 0.5.
    **options
    callback : callable, optional
        Function that the identifier's thread calls with each `OnlineEstimate`. The next call, or the end of the
        `with` block, raises the callback's exceptions.

    Raises
    ------
    InputError
        Settings are invalid (raised at once), or samples are invalid (raised by the next call).

    Examples
    --------
    >>> with jid.OnlineIdentifier(joint, window=10.0) as identifier:
    ...     for block in recording.split(24):  # half a second each, as a drive delivers them
    ...         identifier.feed(
    ...             time=block.time,
    ...             position=block.position,
    ...             velocity=block.velocity,
    ...             torque=block.torque,
    ...             sensor=block.sensor,
    ...         )
    ...     latest = identifier.wait()  # `identifier.estimate` does not wait
    >>> bool(abs(latest.joint.parameters["coulomb"].value - 25.0) < 0.5)
    True
    """

    def __init__(
        self,
        joint: Joint | None = None,
        *,
        window: float = 30.0,
        update: float = 0.5,
        callback: Callable[[OnlineEstimate], object] | None = None,
        **options: Unpack[OnlineOptions],
    ) -> None:
        if callback is not None and not callable(callback):
            raise InputError("a function is expected", argument="callback", value=callback)
        self._settings = OnlineSettings(
            joint=joint,
            window=window,
            update=update,
            posed=Settings.of(checked_options(OnlineOptions, options)),
        )
        self._signals: tuple[str, ...] | None = None
        self._last_time = -np.inf
        self._feeding = threading.RLock()
        self._worker = Worker(self._settings, callback)
        weakref.finalize(self, self._worker.stop)

    def feed(
        self,
        *,
        time: ArrayLike,
        position: ArrayLike | None = None,
        torque: ArrayLike | None = None,
        **others: ArrayLike | None,
    ) -> None:
        """Add one or several samples. Any thread may call `feed`; the samples of one call stay together.

        Parameters
        ----------
        time : float or array
            Time [s], increasing.
        position, torque : float or array
            Position and torque on the output side [rad, N·m] (or [m, N]).
        **others : float or array
            Further signals: velocity and sensor. Instead of the torque: motor_torque (for a joint with gear_ratio),
            or current (for a joint with gear_ratio and torque_constant). Every call needs the same signals.

        Raises
        ------
        InputError
            Samples of this or an earlier call are invalid.
        """
        for name in others:
            if name not in _OPTIONAL:
                known = ("time", "position", "torque", *_OPTIONAL)
                raise InputError(
                    f"there is no such signal; {suggestion(name, known)}",
                    argument=name,
                    place="samples",
                )
        given = {"time": time, "position": position, "torque": torque, **others}
        with self._feeding:
            self._take(given)

    def _take(self, given: Mapping[str, ArrayLike | None]) -> None:
        """Check samples against the previous ones and pass them to the thread; one caller at a time."""
        here = tuple(name for name, value in given.items() if value is not None)
        signals = self._signals or here
        if "position" not in signals:
            raise InputError(
                "this signal is missing; the position of the output is needed",
                argument="position",
                place="samples",
            )
        samples = checked(given, signals)
        if self._signals is None:
            self._settings.check_signals(signals)
        times = samples["time"]
        if times.size == 0:
            return
        if not (times[0] > self._last_time and bool(np.all(np.diff(times) > 0.0))):
            earlier, later = self._last_time, times[0]
            if later > earlier:
                first = int(np.flatnonzero(np.diff(times) <= 0.0)[0])
                earlier, later = times[first], times[first + 1]
            raise InputError(
                f"time must increase from sample to sample, but the previous time is {earlier} s",
                argument="time",
                value=float(later),
                place="samples",
            )
        self._worker.put({name: values.copy() for name, values in samples.items()})
        self._signals = signals
        self._last_time = float(times[-1])

    @property
    def estimate(self) -> OnlineEstimate | None:
        """Latest estimate; None before the first estimate."""
        return self._worker.latest()

    def wait(self, timeout: float | None = None) -> OnlineEstimate | None:
        """Wait until all samples are processed, and return the latest estimate.

        Parameters
        ----------
        timeout : float, optional
            Longest wait [s]. Default: no limit.

        Raises
        ------
        TimeoutError
            The samples were not processed in time.
        InputError
            The callback calls `wait`, and would wait forever.
        """
        return self._worker.wait(timeout)

    def close(self) -> None:
        """End the thread; samples in the queue are discarded."""
        self._worker.stop()
        self._worker.join()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()
        if error is None:
            self._worker.raise_failure()
