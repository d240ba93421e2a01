"""What no joint's recording holds: absurdly large values."""

from collections.abc import Mapping

import numpy as np

from jointid.recording.signals import FloatArray

LARGEST = 1e15  # in SI: beyond it a value is a mark for "none", or damaged
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


def too_large(signals: Mapping[str, FloatArray]) -> tuple[str, int] | None:
    """Return signal and index of a value that is larger than any of a joint, or None."""
    for signal, values in signals.items():
        if len(values) and max(float(values.max()), -float(values.min())) > LARGEST:
            return signal, int(np.argmax(np.abs(values)))
    return None
