"""The signals of a recording: names, dimensions, units, and what makes their values usable."""

import difflib
from collections.abc import Callable, Collection, Mapping
from typing import TypeGuard

import numpy as np
import numpy.typing as npt

from jointid.base.errors import InputError

FloatArray = npt.NDArray[np.float64]

SIGNALS = (
    *("time", "position", "velocity", "torque", "sensor", "reference", "link_position"),
    *("temperature", "motor_torque", "current"),
)
KINDS = ("revolute", "prismatic")
SHORTEST = 8  # samples: fewer bear no window with a residual left over

# By kind, where the kind matters; the first dimension is the one stored.
_DIMENSIONS: dict[str, tuple[tuple[str, ...], tuple[str, ...]]] = {
    "time": (("time",), ("time",)),
    "position": (("angle",), ("length",)),
    "velocity": (("angular velocity",), ("linear velocity",)),
    "torque": (("torque",), ("force",)),
    # NOTE: the sensor's gain has the unit of torque per reading, so any reading will do.
    "sensor": (("raw reading", "voltage", "torque", "force"),) * 2,
    "reference": (("angle",), ("length",)),
    "link_position": (("angle",), ("length",)),
    "temperature": (("temperature",), ("temperature",)),
    "motor_torque": (("torque",), ("torque",)),
    "current": (("current",), ("current",)),
}
# Dimension → the SI unit as shown and as written into a header.
_SI = {
    "time": ("s", "s"),
    "angle": ("rad", "rad"),
    "length": ("m", "m"),
    "angular velocity": ("rad/s", "rad_s"),
    "linear velocity": ("m/s", "m_s"),
    "torque": ("N·m", "Nm"),
    "force": ("N", "N"),
    "raw reading": ("1", "raw"),
    "temperature": ("°C", "degC"),
    "current": ("A", "A"),
}


def dimensions(signal: str, kind: str | None) -> tuple[str, ...]:
    """Return the dimensions a signal may have in a joint of a kind, of either kind for None."""
    revolute, prismatic = _DIMENSIONS[signal]
    if kind is None:
        return tuple(dict.fromkeys(revolute + prismatic))
    return revolute if kind == "revolute" else prismatic


def shown_unit(signal: str, kind: str) -> str:
    """Return a signal's SI unit as text is written, e.g. ``"N·m"``."""
    return _SI[dimensions(signal, kind)[0]][0]


def header_unit(signal: str, kind: str) -> str:
    """Return a signal's SI unit as headers are written, e.g. ``"Nm"``."""
    return _SI[dimensions(signal, kind)[0]][1]


def check_signal_name(name: object, argument: str) -> None:
    """Refuse what is no signal's name, with a suggestion."""
    if name not in SIGNALS:
        close = closest(name, SIGNALS)
        meant = f", did you mean {close!r}" if close else f"; signals are {', '.join(SIGNALS)}"
        raise InputError(f"{argument}: {name!r} is no signal{meant}")


def closest(name: object, known: Collection[str]) -> str | None:
    """Return the known name nearest to a misspelt one, or None."""
    by_folded = {each.casefold(): each for each in known}
    close = difflib.get_close_matches(str(name).casefold(), by_folded, n=1)
    return by_folded[close[0]] if close else None


def signal_array(name: str, values: npt.ArrayLike, place: str = "") -> FloatArray:
    """Return values as a read-only contiguous float64 array of one dimension.

    They are copied, unless nobody can write to them.

    Raises
    ------
    InputError
        They are not numbers, masked, or not one-dimensional.
    """
    if _frozen(values):
        return values
    before = f"{place}: " if place else ""
    if isinstance(values, np.ma.MaskedArray) and np.ma.getmaskarray(values).any():
        index = int(np.flatnonzero(np.ma.getmaskarray(values))[0])
        raise InputError(f"{before}{name} is masked at index {index}; leave such samples out")
    try:
        array = np.asarray(values)
        if array.dtype.kind not in "biufO":
            raise TypeError
        if array.dtype.kind == "O":  # text that looks like a number is still text
            _check_numbers(name, array, before)
        with np.errstate(over="ignore"):
            copy = np.array(array, dtype=np.float64, order="C", copy=True)
    except InputError:
        raise
    except (TypeError, ValueError, OverflowError):
        raise InputError(
            f"{before}{name} does not hold numbers; an array of floats is expected"
        ) from None
    if copy.ndim != 1:
        raise InputError(
            f"{before}{name} has the shape {copy.shape}; an array of one dimension is expected"
        )
    copy.flags.writeable = False
    return copy


def _frozen(values: object) -> TypeGuard[FloatArray]:
    """Whether this is a signal's array already: its own memory, closed to writing."""
    return (
        type(values) is np.ndarray
        and values.dtype == np.float64
        and values.ndim == 1
        and values.flags.owndata
        and values.flags.c_contiguous
        and not values.flags.writeable
    )


def _check_numbers(name: str, array: npt.NDArray[np.object_], before: str) -> None:
    for index, value in enumerate(array.flat):
        try:
            number = not isinstance(value, str | bytes) and float(value) is not None
        except (TypeError, ValueError, OverflowError):
            number = False
        if not number:
            raise InputError(
                f"{before}{name} is {str(value)[:40]!r} at index {index}; a number is expected"
            )


def check_signals(
    signals: Mapping[str, FloatArray],
    *,
    place: Callable[[str, int], str] = lambda _signal, index: f"index {index}",
    source: str = "",
    time_advice: str = "",
) -> None:
    """Refuse signals that no recording can hold.

    Parameters
    ----------
    signals : mapping of str to ndarray, each of shape (n,)
        ``"time"`` among them.
    place : callable
        Tells where the sample of a signal at an index stands. Default: ``"index 5"``.
    source : str
        The file, put before what concerns no single sample. Default: none.
    time_advice : str
        Added to the sentence on time stamps that go back. Default: none.

    Raises
    ------
    InputError
        Different lengths, fewer than 8 samples, a value that is not finite, time stamps that do
        not strictly increase.
    """
    before = f"{source}: " if source else ""
    time = signals["time"]
    for name, values in signals.items():
        if len(values) != len(time):
            raise InputError(
                f"{before}{name} has {len(values)} samples and time has {len(time)}; "
                "all signals need the same number"
            )
    if len(time) < SHORTEST:
        raise InputError(
            f"{before}time has {len(time)} samples; a recording needs at least {SHORTEST}"
        )
    for name, values in signals.items():
        finite = np.isfinite(values)
        if not finite.all():
            index = int(np.argmin(finite))
            raise InputError(
                f"{place(name, index)}: {name} is {float(values[index])}; "
                "every sample must be a finite number"
            )
    later = time[1:] > time[:-1]
    if not later.all():
        index = int(np.argmin(later)) + 1
        raise InputError(
            f"{place('time', index)}: time is {float(time[index])!r} after "
            f"{float(time[index - 1])!r}; time stamps must strictly increase{time_advice}"
        )
    if not np.isfinite(4.0 * (float(time[-1]) - float(time[0]))):
        raise InputError(f"{before}time spans more than a double can hold; seconds are expected")
