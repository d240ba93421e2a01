"""Quantiles of intervals: Student's t, and the normal law about an error within known limits."""

import math

from jointid import _core

_FAR = 8.0  # standard errors: the other tail is nothing
_ONE_SIDED = 1.6448536269514722


def quantile(probability: float, freedom: float) -> float:
    """Quantile of Student's t with `freedom` degrees of freedom."""
    return _core.student_quantile(probability, freedom)


def limited_half_width(stderr: float, limit: float) -> float:
    """Half of the shortest symmetric 95 % interval of a value with a normal error and one of at most `limit`.

    It covers 95 % where the second error is as large as it can be, and more elsewhere (Armstrong and Kolesár 2018,
    Econometrica 86): 1.96 standard errors where the limit is 0, the limit and 1.64 of them where it is large.
    """
    if limit > _FAR * stderr or not math.isfinite(stderr):
        return limit + _ONE_SIDED * stderr
    return stderr * _core.covering_half_width(0.95, limit / stderr)
