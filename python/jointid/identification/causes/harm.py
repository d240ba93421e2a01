"""What a cause does to a value: its shift held against the value, its error and what nobody would notice."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from jointid.estimate.causes import Cause, Causes
from jointid.estimate.statistics import ParameterEstimate

ERRORS = 2.0  # standard errors from which a cause does harm
MOVED = 0.05  # share of a value, the same
_NORMAL = 1.959964  # standard errors of half a 95 % interval
_NEGATIVE = 1.5  # of a value: what a shift may take from it
_UNKNOWN, _CLEARLY = 0.5, 2.0  # a value with a larger error is hardly known: it must move by more


def harm_of(
    error: float, shift: float, share: float, left: float, least: float, errors: float
) -> float:
    """The shift over the least one that does harm.

    Parameters
    ----------
    error : float
        Standard error of the value.
    share : float
        The shift as a share of what it is held against.
    left : float
        Share of the misfit that is left with the cause in the model: the error falls with it.
    least : float
        Share below which a number of errors says nothing.
    errors : float
        Standard errors from which a small shift does harm, too.
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

    The interval does not cover a removed effect: there the error is random, plus `more` from the removed effect.
    """
    if more is not None:
        return float(np.hypot(p.stderr or 0.0, more.get(p.name, 0.0)))
    return (p.interval[1] - p.interval[0]) / (2.0 * _NORMAL) if p.interval is not None else 0.0


def scale_of(
    p: ParameterEstimate, parameters: Mapping[str, ParameterEstimate], level: float
) -> float:
    """What a shift is held against: an offset, or one phase of a harmonic, may be zero."""
    if "offset" in p.name:
        return max(abs(p.value), level)
    for one, other in (("_cos", "_sin"), ("_sin", "_cos")):
        pair = parameters.get(p.name.replace(one, other)) if one in p.name else None
        if pair is not None:
            return float(np.hypot(p.value, pair.value))
    return abs(p.value)


def possible(causes: Causes, parameters: Mapping[str, ParameterEstimate]) -> Causes:
    """Return causes without those that would make a value clearly negative that cannot be: something else is amiss."""

    def is_possible(cause: Cause) -> bool:
        return all(
            shift >= -_NEGATIVE * abs(parameters[name].value)
            for name, shift in cause.shifts.items()
            if parameters[name].min == 0.0
        )

    return replace(causes, found=tuple(filter(is_possible, causes.found)))
