"""The signals of a recording: their names, dimensions and units, and checks of their values."""

from collections.abc import Callable, Collection, Mapping
from typing import Literal, TypeGuard, get_args

import numpy as np
import numpy.typing as npt

from jointid.base.advice import Action
from jointid.base.errors import InputError

FloatArray = npt.NDArray[np.float64]

SIGNALS = (
    *("time", "position", "velocity", "torque", "sensor", "reference", "link_position"),
    *("temperature", "motor_torque", "current", "late"),
)
NEEDED = ("time", "position")
TORQUES = ("torque", "motor_torque", "current")  # one of them is needed
Kind = Literal["revolute", "prismatic"]
TorqueHold = Literal["zoh", "linear"]
KINDS: tuple[str, ...] = get_args(Kind)
SHORTEST = 8  # samples: with fewer, no window has a residual

# Dimensions for a revolute and for a prismatic joint; the first one is stored.
_DIMENSIONS: dict[str, tuple[tuple[str, ...], tuple[str, ...]]] = {
    "time": (("time",), ("time",)),
    "position": (("angle",), ("length",)),
    "velocity": (("angular velocity",), ("linear velocity",)),
    "torque": (("torque",), ("force",)),
    # NOTE: the sensor's gain has the unit of torque per reading, so any kind of reading is accepted.
    "sensor": (("raw reading", "voltage", "torque", "force"),) * 2,
    "reference": (("angle",), ("length",)),
    "link_position": (("angle",), ("length",)),
    "temperature": (("temperature",), ("temperature",)),
    "motor_torque": (("torque",), ("torque",)),
    "current": (("current",), ("current",)),
    "late": (("cycles",), ("cycles",)),
}
# Dimension → SI unit in texts, and in headers.
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
    "cycles": ("1", "cycles"),
    "inertia": ("kg·m²", "kgm2"),
    "voltage": ("V", "V"),
}


def dimensions(signal: str, kind: str | None) -> tuple[str, ...]:
    """Return the possible dimensions of a signal for a kind of joint; None: for both kinds."""
    revolute, prismatic = _DIMENSIONS[signal]
    if kind is None:
        return tuple(dict.fromkeys(revolute + prismatic))
    return revolute if kind == "revolute" else prismatic


def shown_unit(signal: str, kind: str) -> str:
    """Return a signal's SI unit for texts, e.g. ``"N·m"``."""
    return _SI[dimensions(signal, kind)[0]][0]


def shown_dimension(dimension: str) -> str:
    """Return the SI unit of a dimension for texts, e.g. ``"N·m"``; empty for an unknown one."""
    return _SI.get(dimension, ("", ""))[0]


def header_unit(signal: str, kind: str) -> str:
    """Return a signal's SI unit for headers, e.g. ``"Nm"``."""
    return _SI[dimensions(signal, kind)[0]][1]


def check_signal_name(name: object, argument: str) -> None:
    """Raise `InputError` with a suggestion if the name is not a signal's.

    Parameters
    ----------
    name : object
    argument : str
        Argument that contains the name.
    """
    if name not in SIGNALS:
        close = closest(name, SIGNALS)
        of_motor = Action("call", {"side": {close: "motor"}}, "for a motor-side signal", "load")
        sided = close in ("position", "velocity") and "motor" in str(name).casefold()
        raise InputError(
            f"{name!r} is not a signal",
            argument=argument,
            remedy=(
                f"did you mean {close!r}" if close else f"signals are {', '.join(SIGNALS)}",
                *([of_motor] if sided else []),
            ),
        )


def closest(name: object, known: Collection[str], cutoff: float = 0.6) -> str | None:
    """Return the known name closest to a misspelt one, or None if the similarity is below `cutoff`."""
    import difflib

    by_folded = {each.casefold(): each for each in known}
    close = difflib.get_close_matches(str(name).casefold(), by_folded, n=1, cutoff=cutoff)
    return by_folded[close[0]] if close else None


def signal_array(name: str, values: npt.ArrayLike, place: str = "") -> FloatArray:
    """Return values as a read-only, contiguous, one-dimensional float64 array.

    Values are copied, unless they are already such an array.

    Parameters
    ----------
    name : str
        Argument that the values come from; ``""`` if `place` states it.
    values : array_like, shape (n,)
    place : str
        File and column, for messages. Default: none.

    Raises
    ------
    InputError
        Values are not numbers, are masked, or are not one-dimensional.
    """
    if _frozen(values):
        return values
    # Import numpy.ma only for values with a mask.
    if hasattr(values, "mask") and isinstance(values, np.ma.MaskedArray) and values.mask.any():
        index = int(np.flatnonzero(values.mask)[0])
        raise InputError(
            f"masked at index {index}", argument=name, place=place, remedy="leave such samples out"
        )
    no_numbers = InputError("an array of numbers is expected", argument=name, place=place)
    try:
        array = np.asarray(values)
    except (TypeError, ValueError, OverflowError):  # lists of different lengths
        raise no_numbers from None
    if array.dtype.kind not in "biufO":
        raise no_numbers
    if array.dtype.kind == "O":  # text that looks like a number is refused
        _check_numbers(name, array, place)
    try:
        with np.errstate(over="ignore"):
            copy = np.array(array, dtype=np.float64, order="C", copy=True)
    except (TypeError, ValueError, OverflowError):
        raise no_numbers from None
    if copy.ndim != 1:
        raise InputError(
            f"the shape is {copy.shape}; an array of one dimension is expected",
            argument=name,
            place=place,
        )
    copy.flags.writeable = False
    return copy


def _frozen(values: object) -> TypeGuard[FloatArray]:
    """Whether this is already a signal's array: contiguous, read-only, and owner of its memory."""
    return (
        type(values) is np.ndarray
        and values.dtype == np.float64
        and values.ndim == 1
        and values.flags.owndata
        and values.flags.c_contiguous
        and not values.flags.writeable
    )


def _check_numbers(name: str, array: npt.NDArray[np.object_], place: str) -> None:
    for index, value in enumerate(array.flat):
        # Older NumPy versions convert a list of one number to this number.
        other = isinstance(value, str | bytes) or (isinstance(value, np.ndarray) and value.ndim > 0)
        try:
            number = not other and float(value) is not None
        except (TypeError, ValueError, OverflowError):
            number = False
        if not number:
            raise InputError(
                f"{str(value)[:40]!r} at index {index} is not a number", argument=name, place=place
            )


def check_signals(
    signals: Mapping[str, FloatArray],
    *,
    place: Callable[[str, int], str] = lambda _signal, index: f"index {index}",
    source: str = "",
    time_remedy: Callable[[], tuple[str | Action, ...]] = tuple,
) -> None:
    """Raise `InputError` for signals that cannot form a recording.

    Parameters
    ----------
    signals : mapping of str to ndarray, each of shape (n,)
        Signals by name, with ``"time"``.
    place : callable
        Takes signal and index, returns the place of this sample. Default: e.g. ``"index 5"``.
    source : str
        The file, for messages about no single sample. Default: none.
    time_remedy : callable
        Returns remedies for time stamps that go back. Default: none.

    Raises
    ------
    InputError
        Lengths differ, there are fewer than 8 samples, a value is not finite, or time stamps do
        not strictly increase.
    """
    time = signals["time"]
    for name, values in signals.items():
        if len(values) != len(time):
            raise InputError(
                f"{len(values)} samples, but time has {len(time)}; all signals need the same number of samples",
                argument=name,
                place=source,
            )
    if len(time) < SHORTEST:
        raise InputError(
            f"{len(time)} samples; a recording needs at least {SHORTEST}",
            argument="time",
            place=source,
        )
    for name, values in signals.items():
        finite = np.isfinite(values)
        if not finite.all():
            index = int(np.argmin(finite))
            raise InputError(
                "every sample must be a finite number",
                argument=name,
                value=float(values[index]),
                place=place(name, index),
            )
    later = time[1:] > time[:-1]
    if not later.all():
        index = int(np.argmin(later)) + 1
        raise InputError(
            f"the sample before is at {float(time[index - 1])!r}, and time stamps must strictly "
            "increase",
            argument="time",
            value=float(time[index]),
            place=place("time", index),
            remedy=time_remedy(),
        )
    if not np.isfinite(4.0 * (float(time[-1]) - float(time[0]))):
        raise InputError(
            "the times span more than a float can hold; seconds are expected",
            argument="time",
            place=source,
        )
