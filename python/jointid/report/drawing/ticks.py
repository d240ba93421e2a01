"""Places and labels of an axis's ticks."""

from __future__ import annotations

import math

from jointid.base.values import dataclass

_SUPERSCRIPTS = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
_DIGITS = 4  # digits after the decimal point; a label with more is a multiple of a power of ten
_LARGEST = 1e5


@dataclass(frozen=True, slots=True)
class Ticks:
    """Ticks of an axis.

    Attributes
    ----------
    values : tuple of float
        Values of the ticks, in the axis's unit.
    texts : tuple of str
        Labels of the ticks: the value over 10^exponent.
    exponent : int
    """

    values: tuple[float, ...]
    texts: tuple[str, ...]
    exponent: int = 0


def linear_ticks(low: float, high: float, most: int) -> Ticks:
    """Return round values (1, 2 or 5 times a power of ten apart) within two limits, at most `most`."""
    step = 1.0
    values: tuple[float, ...] = ()
    power = math.floor(math.log10((high - low) / most))
    for exponent in (power, power + 1):
        for factor in (1, 2, 5):
            step = factor * 10.0**exponent
            first = math.ceil(low / step - 1e-9)
            last = math.floor(high / step + 1e-9)
            if not values and last - first < most:
                values = tuple(number * step for number in range(first, last + 1))
                return _written(values, exponent)
    return _written((low, high), power)


def logarithmic_ticks(low: float, high: float, most: int) -> Ticks:
    """Return powers of ten within two positive limits: every n-th if there are many, also 2 and 5 if there are few."""
    first, last = math.ceil(math.log10(low) - 1e-9), math.floor(math.log10(high) + 1e-9)
    stride = max(1, -(-(last - first + 1) // most))
    powers = range(first, last + 1, stride)
    if len(powers) > 2 or (len(powers) == 2 and most < 4):
        values = tuple(10.0**power for power in powers)
        return Ticks(values, tuple(f"10{superscript(power)}" for power in powers))
    few = [
        factor * 10.0**power
        for power in range(first - 1, last + 1)
        for factor in (1.0, 2.0, 5.0)
        if low * (1.0 - 1e-9) <= factor * 10.0**power <= high * (1.0 + 1e-9)
    ]
    if 2 <= len(few) <= most:
        return Ticks(tuple(few), tuple(f"{value:g}".replace("-", "−") for value in few))
    return linear_ticks(low, high, most)


def superscript(power: int) -> str:
    """Return an exponent in raised digits."""
    return str(power).translate(_SUPERSCRIPTS)


def _written(values: tuple[float, ...], power: int) -> Ticks:
    """Return ticks for values that differ by multiples of 10^power, with as many digits as needed."""
    largest = max(map(abs, values), default=0.0)
    exponent = 0
    if largest >= _LARGEST or (-power > _DIGITS and largest > 0.0):
        exponent = 3 * math.floor(math.log10(largest) / 3.0) if largest > 0.0 else 0
    decimals = max(0, exponent - power)
    texts = (f"{value / 10.0**exponent:.{decimals}f}" for value in values)
    return Ticks(values, tuple(_zero(text).replace("-", "−") for text in texts), exponent)


def _zero(text: str) -> str:
    return "0" if not text.strip("-0.") else text
