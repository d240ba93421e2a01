"""`OnlineIdentifier`: feed samples, get fresh estimates, off the caller's thread."""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Callable, Collection, Mapping
from types import TracebackType
from typing import Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from jointid.errors import InputError
from jointid.identification.model_terms import Request
from jointid.joint.joint import Joint
from jointid.joint.parameters import Parameter
from jointid.online.online_estimate import OnlineEstimate
from jointid.online.samples import checked
from jointid.online.sliding import Settings, Sliding

Array = NDArray[np.float64]

_OPTIONAL = ("velocity", "sensor", "motor_position", "motor_torque", "current")


class OnlineIdentifier:
    """Identify a joint while it runs, from the last seconds of its motion.

    Samples are handed over by `feed`, which returns at once; a thread of the identifier's own digests
    them a stretch at a time, forgets what is older than `window`, and finds the estimate anew. Time
    and memory are bounded: an update costs a few milliseconds whatever the rate of sampling was, and
    nothing older than the window is kept.

    Parameters
    ----------
    joint : Joint, optional
        Known facts, bounds and the model, as for `identify`. Bounds that it does not give are taken
        from the first seconds, and anew when one of them holds a value.
    window : float
        How much of the past counts [s]; default 30.
    update : float
        Time between estimates, and the stretch that is forgotten at once [s]; default 0.5.
    model, asymmetric, ripple, harmonics, load_friction, residual, parameters, torque_hold, mask_standstill
        As for `identify`; of the models those with at most one shape.
    windows : float, optional
        Duration of an integration window [s]. Default: by the noise of the first seconds.
    callback : callable, optional
        Called with each `OnlineEstimate`, on the identifier's thread.

    Raises
    ------
    InputError
        Settings that cannot be, at once; samples that cannot be used, from the next call after them.

    Examples
    --------
    >>> with jid.OnlineIdentifier(joint, window=30.0) as identifier:
    ...     for sample in drive:
    ...         identifier.feed(time=..., position=..., velocity=..., torque=..., sensor=...)
    ...         if identifier.estimate is not None:
    ...             controller = retuned(identifier.estimate.joint)
    """

    def __init__(
        self,
        joint: Joint | None = None,
        *,
        window: float = 30.0,
        update: float = 0.5,
        model: str | None = None,
        asymmetric: bool | None = None,
        ripple: Collection[float] | None = None,
        harmonics: Collection[float] | None = None,
        load_friction: bool | None = None,
        residual: str | None = None,
        parameters: Mapping[str, float | Mapping[str, object] | Parameter] | None = None,
        windows: float | None = None,
        torque_hold: str | None = None,
        mask_standstill: bool = True,
        callback: Callable[[OnlineEstimate], object] | None = None,
    ) -> None:
        if joint is not None and not isinstance(joint, Joint):
            raise InputError(f"joint must be a Joint, got {joint!r}")
        for name, value in (("window", window), ("update", update), ("windows", windows)):
            if value is not None and not (np.isfinite(value) and value > 0.0):
                raise InputError(f"{name} must be above 0 and finite [s], got {value!r}")
        if window < 4.0 * update:
            raise InputError(
                f"window must be at least four times update, got {window:g} and {update:g} s"
            )
        chosen = model or (joint.friction if joint is not None else None)
        if chosen == "stribeck_general":
            raise InputError(
                "model 'stribeck_general' has two shapes, which is too much between two samples; use 'stribeck' on-line"
            )
        if callback is not None and not callable(callback):
            raise InputError(f"callback must be callable, got {callback!r}")
        self._settings = Settings(
            joint=joint,
            window=float(window),
            update=float(update),
            request=Request(
                model=model,
                residual=residual,
                asymmetric=asymmetric,
                ripple=ripple,
                harmonics=harmonics,
                load_friction=load_friction,
                per_recording=(),
            ),
            parameters=parameters,
            windows=windows,
            torque_hold=torque_hold,
            mask_standstill=mask_standstill,
        )
        self._callback = callback
        self._signals: tuple[str, ...] | None = None
        self._last_time = -np.inf
        self._condition = threading.Condition()
        self._waiting: deque[dict[str, Array]] = deque()
        self._held = 0.0  # seconds of samples that wait
        self._dropped = 0
        self._busy = False
        self._closed = False
        self._failure: BaseException | None = None
        self._estimate: OnlineEstimate | None = None
        self._thread: threading.Thread | None = None

    def feed(
        self,
        *,
        time: ArrayLike,
        position: ArrayLike | None = None,
        torque: ArrayLike | None = None,
        **others: ArrayLike | None,
    ) -> None:
        """Hand over one sample, or several of equal length.

        Parameters
        ----------
        time : float or array
            [s], increasing.
        position, torque : float or array
            Output side [rad, N·m] (or [m, N]).
        **others : float or array
            velocity, sensor, and the motor's side: motor_position, motor_torque, current; the same
            signals at every call.

        Raises
        ------
        InputError
            Samples that cannot be used, these or earlier ones.
        """
        for name in others:
            if name not in _OPTIONAL:
                raise InputError(
                    f"feed: there is no signal '{name}'; there are time, position, torque, {', '.join(_OPTIONAL)}"
                )
        given = {"time": time, "position": position, "torque": torque, **others}
        here = tuple(name for name, value in given.items() if value is not None)
        signals = self._signals or here
        if not {"position", "motor_position"} & set(signals):
            raise InputError("feed: samples need a position, of the output or the motor's side")
        samples = checked(given, signals)
        times = samples["time"]
        if times.size == 0:
            return
        if not (times[0] > self._last_time and bool(np.all(np.diff(times) > 0.0))):
            raise InputError(
                f"feed: time must increase from sample to sample, got {times[0]} s after {self._last_time} s"
                if times[0] <= self._last_time
                else "feed: time must increase from sample to sample"
            )
        with self._condition:
            self._raise_failure()
            if self._closed:
                raise InputError("feed: the identifier is closed")
            self._signals = signals
            self._last_time = float(times[-1])
            self._waiting.append({name: values.copy() for name, values in samples.items()})
            self._bound()
            if self._thread is None:
                self._thread = threading.Thread(
                    target=self._work, name="jointid on-line", daemon=True
                )
                self._thread.start()
            self._condition.notify_all()

    @property
    def estimate(self) -> OnlineEstimate | None:
        """The latest, or None before the first."""
        with self._condition:
            self._raise_failure()
            return self._estimate

    def wait(self, timeout: float | None = None) -> OnlineEstimate | None:
        """Wait until all samples handed over have been looked at; the latest estimate.

        Raises
        ------
        TimeoutError
            They have not within `timeout` seconds.
        """
        with self._condition:
            done = self._condition.wait_for(
                lambda: self._failure is not None or (not self._waiting and not self._busy), timeout
            )
            self._raise_failure()
            if not done:
                raise TimeoutError(f"the samples were not digested within {timeout} s")
            return self._estimate

    def close(self) -> None:
        """End the thread; samples that wait are not looked at."""
        with self._condition:
            self._closed = True
            self._waiting.clear()
            self._condition.notify_all()
        if self._thread is not None and self._thread is not threading.current_thread():
            self._thread.join()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()

    def _bound(self) -> None:
        """Keep no more than a window of samples waiting: the oldest go."""
        while (
            len(self._waiting) > 1
            and self._last_time - self._waiting[0]["time"][0] > self._settings.window
        ):
            self._dropped += self._waiting.popleft()["time"].size

    def _raise_failure(self) -> None:
        failure, self._failure = self._failure, None
        if failure is not None:
            raise failure

    def _work(self) -> None:
        assert self._signals is not None
        sliding = Sliding(self._settings, self._signals)
        while True:
            with self._condition:
                self._busy = False
                self._condition.notify_all()
                self._condition.wait_for(lambda: self._closed or bool(self._waiting))
                if self._closed:
                    return
                taken = list(self._waiting)
                self._waiting.clear()
                self._busy = True
                dropped = self._dropped
            try:
                for samples in taken:
                    sliding.append(samples)
                found = sliding.estimate(dropped)
            except Exception as error:  # told by the next call; the past may have been at fault
                with self._condition:
                    self._failure = error
                sliding = Sliding(self._settings, self._signals)
                continue
            if found is not None:
                self._tell(found)

    def _tell(self, found: OnlineEstimate) -> None:
        with self._condition:
            self._estimate = found
        if self._callback is None:
            return
        try:
            self._callback(found)
        except Exception as error:  # the user's own, told by the next call
            with self._condition:
                self._failure = error
