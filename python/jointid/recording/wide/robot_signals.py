"""Checks of the arrays of a robot's recording: one row per sample, one column per joint."""

import re
from collections.abc import Mapping, Sequence

import numpy as np
import numpy.typing as npt

from jointid.base.advice import Action
from jointid.base.errors import InputError
from jointid.recording.extra import check_extra_name
from jointid.recording.sides import checked_ratio
from jointid.recording.signals import FloatArray, signal_array

ROBOT_SIGNALS = (
    *("position", "velocity", "torque", "motor_torque", "current"),
    *("sensor", "reference", "link_position", "temperature"),
)
LISTED = "joints_listed"  # metadata key: the user named the joints one by one
_MOST = 10_000  # joints: more mean that samples and joints are swapped
_IN_HEADERS = r"[^,;\"'\[\](){}\t\r\n]+"


def joint_arrays(
    time: FloatArray, given: Mapping[str, npt.ArrayLike | None]
) -> dict[str, FloatArray]:
    """Return the signals present as read-only arrays of shape (n, joints).

    Raises
    ------
    InputError
        The position is missing, or a signal has another shape or values that are not numbers.
    """
    if given["position"] is None:
        raise InputError("a recording needs time and position", argument="position", value=None)
    arrays: dict[str, FloatArray] = {}
    for name, values in given.items():
        if values is None:
            continue
        array = _matrix(name, values)
        joints = arrays["position"].shape[1] if arrays else array.shape[1]
        if array.shape != (len(time), joints):
            hint = "; are samples and joints swapped?" if array.shape[1] == len(time) else ""
            raise InputError(
                f"its shape is {array.shape}; {(len(time), joints)} is expected, one row per sample and one column "
                f"per joint{hint}",
                argument=name,
            )
        _check_absent(name, array)
        arrays[name] = array
    return arrays


def _matrix(name: str, values: npt.ArrayLike) -> FloatArray:
    try:
        array = np.asarray(values)
    except (TypeError, ValueError, OverflowError):
        raise InputError("an array of numbers is expected", argument=name) from None
    if array.ndim != 2 or not 0 < array.shape[1] <= _MOST:
        raise InputError(
            f"its shape is {array.shape}; one row per sample and one column per joint are expected",
            argument=name,
        )
    if array is values and array.dtype == np.float64 and _frozen(array):
        return array
    flat = signal_array(name, array.reshape(-1))
    matrix = np.array(flat.reshape(array.shape), order="F")
    matrix.flags.writeable = False
    return matrix


def _frozen(array: FloatArray) -> bool:
    """Whether an array can no longer change, so that it needs no copy."""
    flags = array.flags
    return flags.owndata and flags.f_contiguous and not flags.writeable


def _check_absent(name: str, array: FloatArray) -> None:
    """Refuse a column that is partly NaN; a column of only NaN is an absent signal."""
    missing = np.isnan(array)
    partly = np.flatnonzero(missing.any(axis=0) & (~missing.all(axis=0) | (name == "position")))
    if len(partly):
        column = int(partly[0])
        raise InputError(
            "every sample must be a finite number",
            argument=f"{name}[:, {column}]",
            value=float("nan"),
            place=f"index {int(np.argmax(missing[:, column]))}",
        )


def extra_arrays(
    extra: Mapping[str, npt.ArrayLike], time: FloatArray, joints: int
) -> dict[str, FloatArray]:
    """Return further signals as read-only arrays of shape (n,) or (n, joints)."""
    if not isinstance(extra, Mapping):
        raise InputError("a mapping of names to arrays is expected", argument="extra", value=extra)
    found = {}
    for name, values in extra.items():
        place = f"extra.{name}"
        check_extra_name(name, "extra")
        array = np.asarray(values)
        fitted = signal_array(place, array) if array.ndim == 1 else _matrix(place, array)
        if fitted.shape not in ((len(time),), (len(time), joints)):
            raise InputError(
                f"its shape is {fitted.shape}; {(len(time),)} or {(len(time), joints)} is expected",
                argument=place,
            )
        found[name] = fitted
    return found


def checked_names(names: Sequence[str] | None, joints: int) -> tuple[str, ...]:
    """Return the joints' names; default "1", "2", ..."""
    if names is None:
        return tuple(str(number) for number in range(1, joints + 1))
    if isinstance(names, str) or len(names) != joints:
        raise InputError(
            f"one name for each of the {joints} joints is expected", argument="names", value=names
        )
    for name in names:
        if not isinstance(name, str) or not re.fullmatch(_IN_HEADERS, name) or name != name.strip():
            raise InputError(
                "a text without brackets, commas or quotes is expected",
                argument="names",
                value=name,
            )
    twice = [name for name in names if list(names).count(name) > 1]
    if twice:
        raise InputError("two joints have this name", argument="names", value=twice[0])
    return tuple(names)


def checked_ratios(
    gear_ratio: Sequence[float] | FloatArray | float | None, joints: int
) -> tuple[float, ...] | None:
    """Return one gear ratio per joint."""
    if gear_ratio is None:
        return None
    found = value_of_each("gear_ratio", gear_ratio, joints, "load")
    return tuple(checked_ratio(each) for each in found)


def value_of_each(argument: str, values: object, joints: int, function: str) -> tuple[float, ...]:
    """Return one value per joint, none of them 0. A single value for several joints is refused with a proposed list.

    Parameters
    ----------
    argument : str
        "gear_ratio", "gear_ratios" or "torque_constants".
    values : object
        A number, or one number per joint.
    joints : int
    function : str
        Function with this argument, for the call that a message proposes.

    Raises
    ------
    InputError
        The number of values is wrong, a single value is given for several joints, or a value is impossible.
    """
    what = argument.removesuffix("s").replace("_", " ")
    try:
        array = np.atleast_1d(np.asarray(values, dtype=np.float64))
    except (OverflowError, TypeError, ValueError):
        array = np.full(0, np.nan)
    if array.shape == (1,) and joints > 1 and np.isfinite(array[0]) and array[0] != 0.0:
        single = float(array[0])
        raise InputError(
            f"one {what} is given for {joints} joints, but each joint needs its own {what}",
            argument=argument,
            value=single,
            remedy=Action(
                "call",
                {argument: [single] * joints},
                "if all joints have this value",
                function=function,
            ),
        )
    if array.shape != (joints,):
        raise InputError(
            f"one {what} for each of the {joints} joints is expected",
            argument=argument,
            value=values,
        )
    if not np.all(np.isfinite(array)) or 0.0 in array:
        raise InputError(
            f"a {what} is a finite number other than 0", argument=argument, value=values
        )
    return tuple(array.tolist())
