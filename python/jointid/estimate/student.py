"""Quantiles of intervals: Student's t, and a normal error plus an error within known limits."""

import math

from jointid import _core

_FAR = 8.0  # standard errors: beyond this the other tail is negligible
_ONE_SIDED = 1.6448536269514722


def quantile(probability: float, freedom: float) -> float:
    """Return the quantile of Student's t with `freedom` degrees of freedom."""
    return _core.student_quantile(probability, freedom)


def limited_half_width(stderr: float, limit: float) -> float:
    """Return half of the shortest symmetric 95 % interval for a normal error plus an error of at most `limit`.

    It covers 95 % if the second error is at its limit, and more otherwise (Armstrong and Kolesár 2018,
    Econometrica 86). It is 1.96 standard errors for a limit of 0, and the limit plus 1.64 of them for a large limit.
    """
    if limit > _FAR * stderr or not math.isfinite(stderr):
        return limit + _ONE_SIDED * stderr
    return stderr * _core.covering_half_width(0.95, limit / stderr)
