"""What no joint's recording holds: stamps whose unit is not seconds, and absurdly large values."""

from collections.abc import Mapping

import numpy as np

from jointid.base.advice import Action
from jointid.base.errors import InputError
from jointid.recording.signals import FloatArray

LARGEST = 1e15  # in SI: beyond it a value is a mark for "none", or damaged
_EXAMINED = 100_000  # steps
# Median step of the stamps in the file's numbers → the unit it shows. From 20 Hz to 20 kHz only one fits.
_STEPS = (
    (50.0, ("s",)),
    (200.0, ("us", "ms")),
    (5e4, ("us",)),
    (2e5, ("ns", "us")),
    (1e9, ("ns",)),
)

_SLOW = 0.5  # [s]: a sample period in which friction's events are over
TIME_UNITS = {"ms": "milliseconds", "us": "microseconds", "ns": "nanoseconds"}
_USUAL = 0.05  # [s]: the longest period that a unit is guessed for


def time_unit(period: float) -> str:
    """Return the unit in which stamps that are `period` apart give a usual sample period."""
    factors = {"ms": 1e-3, "us": 1e-6}
    return next((unit for unit, factor in factors.items() if period * factor <= _USUAL), "ns")


def slow_stamps(period: float) -> tuple[str, str] | None:
    """Return what is said about a sample period [s] that is probably none, and the unit; None for a usual one."""
    if period < _SLOW:
        return None
    unit = time_unit(period)
    return (
        f"the samples are {period:.3g} s apart: the time stamps may be in {TIME_UNITS[unit]}",
        unit,
    )


def unit_of_steps(stamps: FloatArray, place: str) -> str:
    """Return the unit that the steps of stamps show for which no unit is stated.

    Parameters
    ----------
    stamps : ndarray, shape (n,)
        As in the file.
    place : str
        For messages.

    Returns
    -------
    str
        ``"s"``, ``"us"`` or ``"ns"``. Milliseconds are not told from seconds: 1 may be either.

    Raises
    ------
    InputError
        Two units are as likely, or none is.
    """
    with np.errstate(all="ignore"):
        steps = np.diff(stamps[:_EXAMINED])
        steps = steps[steps > 0.0]
    if not len(steps) or not np.isfinite(step := float(np.median(steps))):
        return "s"
    units = next((units for below, units in _STEPS if step < below), ())
    if len(units) == 1:
        return units[0]
    reason = (
        f"no unit is stated, and the samples are {step:.6g} apart, which is too long in seconds"
    )
    raise InputError(
        reason if units else f"{reason} and in every other unit",
        argument="time",
        place=place,
        remedy=tuple(Action("call", {"units": {"time": unit}}, function="load") for unit in units)
        or "choose another column",
    )


def too_large(signals: Mapping[str, FloatArray]) -> tuple[str, int] | None:
    """Return signal and index of a value that is larger than any of a joint, or None."""
    for signal, values in signals.items():
        if len(values) and max(float(values.max()), -float(values.min())) > LARGEST:
            return signal, int(np.argmax(np.abs(values)))
    return None
