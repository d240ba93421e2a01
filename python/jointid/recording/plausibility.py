"""Checks for implausibly large values and sample periods."""

import math
from collections.abc import Mapping

import numpy as np

from jointid.recording.signals import FloatArray

LARGEST = 1e15  # in SI units: a larger value is damaged, or a code for "missing"
_SLOW = 0.5  # [s]: a longer sample period misses all changes of friction
TIME_UNITS = {"ms": "milliseconds", "us": "microseconds", "ns": "nanoseconds"}
_USUAL = 0.05  # [s]: longest usual period, for the guess of a unit


def time_unit(period: float) -> str:
    """Return the unit in which `period` is a usual sample period."""
    factors = {"ms": 1e-3, "us": 1e-6}
    return next((unit for unit, factor in factors.items() if period * factor <= _USUAL), "ns")


def slow_stamps(period: float) -> tuple[str, str] | None:
    """Return a remark on an unlikely sample period [s], and its likely unit; None for a usual period."""
    if period < _SLOW:
        return None
    unit = time_unit(period)
    return (
        f"the samples are {period:.3g} s apart: the time stamps may be in {TIME_UNITS[unit]}",
        unit,
    )


def too_large(signals: Mapping[str, FloatArray]) -> tuple[str, int] | None:
    """Return signal and index of a value that is impossible for a joint, or None."""
    for signal, values in signals.items():
        if len(values) and max(float(values.max()), -float(values.min())) > LARGEST:
            return signal, int(np.argmax(np.abs(values)))
    return None


# Largest usual magnitude of a joint with a gear, in SI units, and likely reasons for a larger one.
_USUAL_AMOUNTS = {
    ("position", "revolute"): (4.0 * math.pi, "degrees, counts, or a motor-side angle"),
    ("velocity", "revolute"): (20.0, "degrees per second, rpm, or a motor-side velocity"),
    ("torque", "revolute"): (5e3, "mN·m or a raw reading"),
    ("current", "revolute"): (200.0, "mA"),
    ("position", "prismatic"): (10.0, "millimetres"),
    ("velocity", "prismatic"): (10.0, "millimetres per second"),
    ("torque", "prismatic"): (1e5, "mN or a raw reading"),
    ("current", "prismatic"): (200.0, "mA"),
}


def range_remark(signal: str, low: float, high: float, kind: str = "revolute") -> str:
    """Return a remark on an unusual range of a signal; empty for a usual range.

    Parameters
    ----------
    signal : str
    low, high : float
        Smallest and largest value, in SI units.
    kind : {"revolute", "prismatic"}

    Examples
    --------
    >>> range_remark("position", -59.9, 59.9)
    'up to 9.5 turns: degrees, counts, or a motor-side angle?'
    >>> range_remark("position", -1.0, 1.0)
    ''
    """
    most = max(abs(low), abs(high))
    if signal != "time" and low == high:
        return "it never changes"
    usual, instead = _USUAL_AMOUNTS.get((signal, kind), (math.inf, ""))
    if most <= usual:
        return ""
    turns = signal == "position" and kind == "revolute"
    amount = most / (2.0 * math.pi) if turns else most
    shown = f"{amount:.2g}" if amount < 100.0 else f"{amount:,.0f}"
    return f"up to {shown}{' turns' if turns else ''}: {instead}?"
