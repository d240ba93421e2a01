"""`OnlineIdentifier`: estimates from samples as they arrive, computed on a thread of its own."""

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

    `feed` takes samples and returns at once. A thread of the identifier processes them piece by piece,
    removes those older than `window`, and computes a new estimate. Time and memory are bounded: an update
    takes a few milliseconds at any sample rate, and nothing older than the window is kept. Windows of
    integration and bounds are chosen as in `identify`; they are checked while the window fills, and then
    once per window. A window of integration has at least five samples: below about 50 samples per second
    the default window of 30 s has few of them, and the estimate is less accurate near reversals. The gain is
    found by regression: `residual` is "sensor" (default with a sensor) or "torque".

    `close`, or the end of a `with` block, ends the thread; so does deleting the identifier, unless its
    callback refers to it.

    Parameters
    ----------
    joint : Joint, optional
        Known values, bounds and the model, as for `identify`. Bounds that it does not state are computed
        from the first seconds, and again if one of them holds a parameter.
    window : float
        Duration of the past that estimates use [s]; default 30.
    update : float
        Time between estimates, and duration of a piece [s], rounded up to a whole number of integration
        windows; default 0.5.
    **options
    callback : callable, optional
        Called with each `OnlineEstimate`, on the identifier's thread. The next call, or the end of the
        `with` block, raises the exceptions of the callback.

    Raises
    ------
    InputError
        Settings that cannot be used, at once; samples that cannot be used, in the next call after them.

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
        """Add one sample, or several. Any thread may do so; each call is taken as a whole.

        Parameters
        ----------
        time : float or array
            [s], increasing.
        position, torque : float or array
            Output side [rad, N·m] (or [m, N]).
        **others : float or array
            velocity, sensor; instead of the torque, motor_torque or current, which a joint with
            gear_ratio (and torque_constant) converts. The same signals in every call.

        Raises
        ------
        InputError
            Samples that cannot be used, these or earlier ones.
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
        """Check samples against those before, and hand them to the thread; by one caller at a time."""
        here = tuple(name for name, value in given.items() if value is not None)
        signals = self._signals or here
        if "position" not in signals:
            raise InputError(
                "it is missing; the position of the output is needed",
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
                f"time must increase from sample to sample, and the one before is {earlier} s",
                argument="time",
                value=float(later),
                place="samples",
            )
        self._worker.put({name: values.copy() for name, values in samples.items()})
        self._signals = signals
        self._last_time = float(times[-1])

    @property
    def estimate(self) -> OnlineEstimate | None:
        """The latest estimate, or None before the first."""
        return self._worker.latest()

    def wait(self, timeout: float | None = None) -> OnlineEstimate | None:
        """Wait until all samples are processed, and return the latest estimate.

        Parameters
        ----------
        timeout : float, optional
            [s]. Default: no limit.

        Raises
        ------
        TimeoutError
            The samples were not processed in time.
        InputError
            Called from the callback, which would wait for itself.
        """
        return self._worker.wait(timeout)

    def close(self) -> None:
        """End the thread; samples in the queue are not processed."""
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
