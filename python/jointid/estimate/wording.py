"""Numbers as people write them."""

import numpy as np


def percent(share: float) -> str:
    """A share as people write it: two digits, never an exponent."""
    value = 100.0 * share
    return f"{value:.0f} %" if value >= 10.0 else f"{value:.2g} %"


def number(value: float) -> str:
    """Six significant digits, without an exponent where people do not write one."""
    return f"{value:.6g}"


def two_digits(value: float) -> str:
    """Two significant digits, as people write them: 110, not 1.1e+02."""
    if not np.isfinite(value) or value < 1e-4:
        return f"{value:.2g}"
    return str(np.format_float_positional(float(f"{value:.1e}"), trim="-"))
