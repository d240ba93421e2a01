"""Formatting of numbers in tables and messages."""

import math

_FAR_BELOW = 1e-3  # of the error: a smaller value is shown as 0
_MOST_DIGITS = 7  # digits of a value with a tiny error


def percent(share: float) -> str:
    """Return a share in per cent: two digits, never an exponent."""
    value = 100.0 * share
    return f"{value:.0f} %" if value >= 10.0 else f"{value:.2g} %"


def signed_percent(share: float) -> str:
    """Return a change in per cent, with its sign."""
    return ("+" if share >= 0.0 else "−") + percent(abs(share))


def number(value: float) -> str:
    """Return six significant digits, without an exponent for usual magnitudes."""
    return f"{value:.6g}"


def two_digits(value: float) -> str:
    """Return two significant digits without an exponent: 110, not 1.1e+02; 1.0, not 1."""
    if not math.isfinite(value) or value < 1e-4:
        return f"{value:.2g}"
    mantissa, exponent = f"{value:.1e}".split("e")
    return f"{float(f'{mantissa}e{exponent}'):.{max(0, 1 - int(exponent))}f}"


def rounded(value: float, stderr: float) -> str:
    """Return a value rounded to its standard error (finite, above 0): 2030 for an error of 170, 7.74 for 0.21."""
    error = two_digits(stderr)
    if "e" in error:
        if abs(value) < _FAR_BELOW * stderr:
            return "0"
        digits = math.floor(math.log10(abs(value))) - math.floor(math.log10(stderr)) + 2
        text = f"{value:#.{min(max(1, digits), _MOST_DIGITS)}g}"
        return text.rstrip(".").replace(".e", "e")
    behind = len(error.partition(".")[2])
    if not behind:  # e.g. an error of 1700: round to hundreds
        behind = min(0, 2 - len(error))
    return f"{round(value, behind):z.{max(behind, 0)}f}"


def percent_with_error(share: float, stderr: float) -> str:
    """Return a share with its standard error in per cent; without the error if it is unknown."""
    if not 0.0 < stderr < math.inf:
        return f"{100.0 * share:.3g} %"
    return f"{rounded(100.0 * share, 100.0 * stderr)} ± {two_digits(100.0 * stderr)} %"
