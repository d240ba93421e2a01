"""Harm of a cause to a value: its shift compared with the value, its error, and a negligible share."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from jointid.estimate.causes import Cause, Causes
from jointid.estimate.statistics import ParameterEstimate

ERRORS = 2.0  # smallest harmful shift, in standard errors
MOVED = 0.05  # smallest harmful shift, as a share of the value
_NORMAL = 1.959964  # standard errors in half a 95 % interval
_NEGATIVE = 1.5  # largest possible decrease of a non-negative value, as a share of the value
_UNKNOWN, _CLEARLY = 0.5, 2.0  # above this relative error, a shift must exceed this many errors


def harm_of(
    error: float, shift: float, share: float, left: float, least: float, errors: float
) -> float:
    """Return the shift over the smallest harmful shift.

    Parameters
    ----------
    error : float
        Standard error of the value.
    shift : float
        Shift of the value by the cause.
    share : float
        Shift as a share of its reference.
    left : float
        Share of the squared residual that remains with the cause in the model; the error decreases with it.
    least : float
        Share below which a shift is harmless for any number of standard errors.
    errors : float
        Number of standard errors from which a small shift is also harmful.
    """
    moved = abs(shift) / error if error > 0.0 else 0.0
    after = error * np.sqrt(max(left, 0.0))
    scale = abs(shift / share) if share else 0.0
    if after > _UNKNOWN * scale and abs(shift) < _CLEARLY * after:
        return 0.0
    harm = abs(share) / MOVED
    return max(harm, moved / errors) if abs(share) > least else harm


def error_of(p: ParameterEstimate, more: Mapping[str, float] | None = None) -> float:
    """Return the error of a value with its systematic part, so that a shift within the interval does not count.

    The interval does not cover a removed effect. The error is then the random error plus `more` from that effect.
    """
    if more is not None:
        return float(np.hypot(p.stderr or 0.0, more.get(p.name, 0.0)))
    return (p.interval[1] - p.interval[0]) / (2.0 * _NORMAL) if p.interval is not None else 0.0


def scale_of(
    p: ParameterEstimate, parameters: Mapping[str, ParameterEstimate], level: float
) -> float:
    """Return the reference of a shift, which is not only the value, because an offset or a phase may be zero."""
    if "offset" in p.name:
        return max(abs(p.value), level)
    for one, other in (("_cos", "_sin"), ("_sin", "_cos")):
        pair = parameters.get(p.name.replace(one, other)) if one in p.name else None
        if pair is not None:
            return float(np.hypot(p.value, pair.value))
    return abs(p.value)


def possible(causes: Causes, parameters: Mapping[str, ParameterEstimate]) -> Causes:
    """Return causes without the impossible ones: those that make a non-negative value clearly negative."""

    def is_possible(cause: Cause) -> bool:
        return all(
            shift >= -_NEGATIVE * abs(parameters[name].value)
            for name, shift in cause.shifts.items()
            if parameters[name].min == 0.0
        )

    return replace(causes, found=tuple(filter(is_possible, causes.found)))
