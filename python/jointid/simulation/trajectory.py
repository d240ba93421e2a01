"""Desired motions of a joint."""

import functools
import math
from collections.abc import Callable, Sequence
from typing import Any, Self, overload

import numpy as np
import numpy.typing as npt

from jointid import _core
from jointid.base.errors import InputError
from jointid.base.values import dataclass
from jointid.recording.recording import Recording
from jointid.simulation.sums_of_sines import peak_of_sines

FloatArray = npt.NDArray[np.float64]

_MAKE: dict[str, Callable[..., _core.Trajectory]] = {
    "multisine": _core.Trajectory.multisine,
    "sigmoid": _core.Trajectory.sigmoid,
    "step": _core.Trajectory.step,
    "trapezoid": _core.Trajectory.trapezoid,
    "samples": _core.Trajectory.samples,
}

_PLACES = ("distance", "offset")
_FARTHEST = 1e6  # [rad], [m] or [N·m]; beyond, errors of a simulation have no finite square
_MOST_SINES = 5e7  # samples of all sines, to find the peak of a multisine


@dataclass(frozen=True, repr=False)
class Trajectory:
    """Desired motion over time. The class methods create a trajectory.

    For open-loop control, the values are torques [N·m] instead of angles.

    Parameters
    ----------
    form : str
        Name of the class method.
    arguments : tuple
        Names and values of the core's arguments.
    """

    form: str
    arguments: tuple[tuple[str, Any], ...]

    @classmethod
    def thesis(
        cls, amplitude: float = math.radians(20.0), *, cycle: float = 6.0, duration: float = 12.0
    ) -> Self:
        """Return amplitude / 1.3 · (sin wt − ½ sin 2wt) with w = 2π / cycle, a motion from rest (thesis 6-1).

        Parameters
        ----------
        amplitude : float
            Amplitude [rad]. Default 20°.
        cycle : float
            Duration of one cycle [s]. Default 6.
        duration : float
            Duration [s]. Default 12.
        """
        rate = 2.0 * math.pi / _positive("cycle", cycle)
        size = _extent("amplitude", amplitude) / 1.3
        return cls._sines((size, -0.5 * size), (rate, 2.0 * rate), (0.0, 0.0), 0.0, duration)

    @classmethod
    def sine(
        cls, amplitude: float, frequency: float, *, offset: float = 0.0, duration: float
    ) -> Self:
        """Return offset + amplitude · sin(2π · frequency · t).

        Parameters
        ----------
        amplitude, offset : float
            Amplitude and centre [rad].
        frequency : float
            Frequency [Hz].
        duration : float
            Duration [s].
        """
        rate = 2.0 * math.pi * _positive("frequency", frequency)
        return cls._sines((_extent("amplitude", amplitude),), (rate,), (0.0,), offset, duration)

    @classmethod
    def multisine(
        cls,
        amplitude: float,
        *,
        lowest: float,
        highest: float,
        count: int = 8,
        offset: float = 0.0,
        duration: float,
    ) -> Self:
        """Return sines of equal amplitude and evenly spaced frequencies, with Schroeder's phases.

        Parameters
        ----------
        amplitude : float
            Largest deviation from the start [rad].
        lowest, highest : float
            Frequencies of the first and the last sine [Hz].
        count : int
            Number of sines. Default 8.
        offset : float
            Start position [rad]. Default 0.
        duration : float
            Duration [s].
        """
        if not isinstance(count, int) or isinstance(count, bool) or not 1 <= count <= 10_000:
            raise InputError(
                "a whole number from 1 to 10000 is expected",
                argument="Trajectory.count",
                value=count,
            )
        low, high = _positive("lowest", lowest), _positive("highest", highest)
        if low > high:
            raise InputError(
                f"above highest, {high!r}",
                argument="Trajectory.lowest",
                value=low,
                remedy="exchange them",
            )
        rate = 2.0 * np.pi * np.linspace(low, high, count)
        number = np.arange(count)
        phase = -np.pi * number * (number + 1) / count
        if 20.0 * high * _positive("duration", duration) * count > _MOST_SINES:
            raise InputError(
                f"at most {_MOST_SINES / (20.0 * high * count):.3g} s is expected with {count} sines up "
                f"to {high:g} Hz",
                argument="Trajectory.duration",
                value=float(duration),
            )
        # The sampling is fine enough to find the peak to a few thousandths.
        peak = peak_of_sines(rate, phase, duration, int(20 * high * duration) + 2)
        size = _extent("amplitude", amplitude) / peak
        start = offset - size * float(np.sin(phase).sum())
        return cls._sines(
            (size,) * count, tuple(rate.tolist()), tuple(phase.tolist()), start, duration
        )

    @classmethod
    def sines(
        cls,
        *,
        amplitude: float | Sequence[float],
        frequency: float | Sequence[float],
        phase: float | Sequence[float],
        offset: float = 0.0,
        fade: float = 0.0,
        duration: float,
    ) -> Self:
        """Return offset + fade(t) · Σ amplitude · sin(frequency · t + phase).

        Parameters
        ----------
        amplitude : float or sequence of float
            Amplitude of each sine [rad]. A single number of amplitude, frequency or phase is for all sines.
        frequency : float or sequence of float
            Angular frequency of each sine [rad/s].
        phase : float or sequence of float
            Phase of each sine [rad].
        offset : float
            Start and end position [rad]. Default 0.
        fade : float
            Duration of the fade-in at the start and of the fade-out at the end [s]. Both are smooth to the second
            derivative. The motion then starts and ends at rest at `offset`. Default 0: no fading.
        duration : float
            Duration [s].

        Examples
        --------
        >>> motion = Trajectory.sines(
        ...     amplitude=(0.5, 0.2), frequency=(2.0, 5.0), phase=(0.0, 1.0), fade=0.5, duration=12.0
        ... )
        >>> [abs(float(value[0])) for value in motion.sample([12.0])]
        [0.0, 0.0, 0.0]
        """
        groups = {"amplitude": amplitude, "frequency": frequency, "phase": phase}
        sizes = {np.size(values) for values in groups.values() if np.ndim(values)}
        count = sizes.pop() if len(sizes) == 1 else 1
        given = {
            name: _samples(name, values if np.ndim(values) else np.full(count, values))
            for name, values in groups.items()
        }
        for value in given["amplitude"]:
            _extent("amplitude", value)
        return cls._made("multisine", **given, offset=offset, duration=duration, fade=fade)

    @classmethod
    def sigmoid(cls, distance: float, *, rise: float, duration: float) -> Self:
        """Return a move by `distance` along half a cosine in the time `rise`, then rest.

        Parameters
        ----------
        distance : float
            Distance [rad].
        rise, duration : float
            Time of the move, and total duration [s].
        """
        return cls._made("sigmoid", distance=distance, rise=rise, duration=duration)

    @classmethod
    def step(cls, distance: float, *, time: float = 0.0, duration: float) -> Self:
        """Return a jump by `distance` [rad] at `time` [s]."""
        return cls._made("step", distance=distance, time=time, duration=duration)

    @classmethod
    def trapezoid(
        cls, distance: float, *, velocity: float, acceleration: float, duration: float
    ) -> Self:
        """Return a move by `distance` with trapezoidal velocity, then rest.

        Parameters
        ----------
        distance : float
            Distance [rad].
        velocity : float
            Largest velocity [rad/s].
        acceleration : float
            Largest acceleration [rad/s²].
        duration : float
            Duration [s].
        """
        return cls._made(
            "trapezoid",
            distance=distance,
            velocity=velocity,
            acceleration=acceleration,
            duration=duration,
        )

    @classmethod
    def from_samples(cls, time: npt.ArrayLike, position: npt.ArrayLike) -> Self:
        """Return the natural cubic spline through samples. Its time is 0 at the first sample.

        Parameters
        ----------
        time : array_like, shape (n,)
            Sample times [s], strictly increasing.
        position : array_like, shape (n,)
            Positions [rad].
        """
        return cls._made(
            "samples",
            time=_samples("time", time),
            position=_samples("position", position, _FARTHEST),
        )

    @classmethod
    def from_recording(cls, recording: Recording) -> Self:
        """Return the motion of a recording: its reference if it has one, otherwise its position."""
        followed = recording.position if recording.reference is None else recording.reference
        return cls.from_samples(recording.time, followed)

    @property
    def duration(self) -> float:
        """Duration [s]."""
        return self.core.duration

    @functools.cached_property
    def core(self) -> _core.Trajectory:
        """Object of the core."""
        return _MAKE[self.form](**dict(self.arguments))

    @overload
    def sample(self, time: float) -> tuple[float, float, float]: ...

    @overload
    def sample(self, time: npt.ArrayLike) -> tuple[FloatArray, FloatArray, FloatArray]: ...

    def sample(
        self, time: npt.ArrayLike
    ) -> tuple[FloatArray, FloatArray, FloatArray] | tuple[float, float, float]:
        """Return position [rad], velocity [rad/s] and acceleration [rad/s²] at times [s].

        Parameters
        ----------
        time : array_like of shape (n,), or float
            Times [s].

        Returns
        -------
        tuple of three ndarray of shape (n,), or of three float

        Raises
        ------
        InputError
            The argument is not a number or an array of numbers.

        Examples
        --------
        >>> position, velocity, _ = jid.Trajectory.sine(0.5, 0.25, duration=8.0).sample(1.0)
        >>> round(position, 6), round(velocity, 6)
        (0.5, 0.0)
        """
        try:
            times = np.asarray(time, dtype=np.float64)
        except (OverflowError, TypeError, ValueError):
            times = np.empty((0, 0))
        if times.ndim > 1 or not np.isfinite(times).all():
            raise InputError(
                "one time or an array of times [s] is expected", argument="time", value=time
            )
        wanted = self.core.sample(np.atleast_1d(times))
        if times.ndim == 0:
            return float(wanted[0, 0]), float(wanted[0, 1]), float(wanted[0, 2])
        return wanted[:, 0], wanted[:, 1], wanted[:, 2]

    @classmethod
    def _sines(
        cls,
        amplitude: Sequence[float],
        frequency: Sequence[float],
        phase: Sequence[float],
        offset: float,
        duration: float,
    ) -> Self:
        return cls._made(
            "multisine",
            amplitude=tuple(amplitude),
            frequency=tuple(frequency),
            phase=tuple(phase),
            offset=offset,
            duration=duration,
        )

    @classmethod
    def _made(cls, form: str, **arguments: Any) -> Self:
        for name, value in arguments.items():
            if not isinstance(value, tuple):
                arguments[name] = (_extent if name in _PLACES else _number)(name, value)
        trajectory = cls(form, tuple(arguments.items()))
        _ = trajectory.core  # invalid arguments raise here, not at first use
        return trajectory

    def __repr__(self) -> str:
        from jointid.simulation.trajectory_facts import line_of

        return line_of(self.form, self.core)

    def _repr_html_(self) -> str:
        from jointid.simulation.trajectory_facts import html_facts

        return str(html_facts(self.form, self.core))

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (self.form, self.arguments)


def _number(name: str, value: object) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float | np.floating | np.integer):
        raise InputError("a number is expected", argument=f"Trajectory.{name}", value=value)
    return float(value)


def _extent(name: str, value: object) -> float:
    number = _number(name, value)
    if _FARTHEST < abs(number) < math.inf:
        raise InputError(
            f"at most {_FARTHEST:g} rad or m in magnitude is expected",
            argument=f"Trajectory.{name}",
            value=number,
        )
    return number


def _positive(name: str, value: object) -> float:
    number = _number(name, value)
    if not (0.0 < number < math.inf):
        raise InputError(
            "a finite number above 0 is expected", argument=f"Trajectory.{name}", value=number
        )
    return number


def _samples(name: str, values: npt.ArrayLike, largest: float = math.inf) -> tuple[float, ...]:
    try:
        array = np.asarray(values, dtype=np.float64)
    except (OverflowError, TypeError, ValueError):
        raise InputError(
            "an array of numbers is expected", argument=f"Trajectory.{name}", value=values
        ) from None
    if array.ndim != 1:
        raise InputError(
            f"one dimension is expected, but the shape is {array.shape}",
            argument=f"Trajectory.{name}",
        )
    outside = np.flatnonzero(np.isfinite(array) & (np.abs(array) > largest))
    if outside.size:
        _extent(name, float(array[outside[0]]))
    return tuple(array.tolist())
