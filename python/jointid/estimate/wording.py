"""Formatting of numbers in tables and messages."""

import numpy as np


def percent(share: float) -> str:
    """A share in per cent: two digits, never an exponent."""
    value = 100.0 * share
    return f"{value:.0f} %" if value >= 10.0 else f"{value:.2g} %"


def number(value: float) -> str:
    """Six significant digits, without an exponent for usual magnitudes."""
    return f"{value:.6g}"


def two_digits(value: float) -> str:
    """Two significant digits without an exponent: 110, not 1.1e+02."""
    if not np.isfinite(value) or value < 1e-4:
        return f"{value:.2g}"
    return str(np.format_float_positional(float(f"{value:.1e}"), trim="-"))
