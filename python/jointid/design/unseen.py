"""Friction at low speed that the recordings have not seen, and what a next motion looks for instead."""

from __future__ import annotations

import math

import numpy as np

from jointid.estimate.estimate import Estimate
from jointid.estimate.intervals import NORMAL
from jointid.estimate.statistics import ParameterEstimate

_SHAPES = ("stribeck", "stribeck_velocity", "stribeck_exponent")
_STATIC = ("static", "static_positive", "static_negative")
_EXCESS = 0.2  # of Coulomb friction: a static excess that is looked for
_NEGLIGIBLE = 0.02  # of Coulomb friction: a smaller one is not
_FADED = 1.0 / 30.0  # of the top speed: where it fades
_INSIGNIFICANT = 0.5  # of its value: a standard error beyond it


def unseen_friction(estimate: Estimate) -> tuple[dict[str, float], set[str]]:
    """Return values of friction at low speed that is looked for, and the parameters of what is certainly not there.

    Where a bound holds a static excess or it is not significant, its estimate is no value to design a motion for.
    What is looked for is an excess as large as the interval allows, a fifth of the Coulomb friction at most, that
    fades at a thirtieth of the top speed. One that the interval keeps below 2 % of the Coulomb friction is not
    there: it keeps its value.
    """
    found = estimate.parameters
    static = [found[name] for name in _STATIC if name in found and found[name].vary]
    shapes = [found[name] for name in _SHAPES if name in found and found[name].vary]
    assumed: dict[str, float] = {}
    absent: set[str] = set()
    for p in static:
        coulomb = found.get(p.name.replace("static", "coulomb"))
        level = 0.0 if coulomb is None else abs(coulomb.value)
        if not _is_lost(p):
            continue
        largest = math.inf if p.at_bound else p.value + NORMAL * interval_error(p)
        if largest < _NEGLIGIBLE * level or level == 0.0:
            absent.add(p.name)
        else:
            assumed[p.name] = _inside(estimate, p.name, min(largest, _EXCESS * level))
    lost = static and len(absent) + len(assumed) == len(static)
    speed = float(np.max(np.abs(estimate.windows.velocity), initial=0.0))
    fading = _FADED * speed if speed > 0.0 else 1.0
    typical = {"stribeck": fading**-2.0, "stribeck_velocity": fading, "stribeck_exponent": 2.0}
    for p in shapes:
        if len(absent) == len(static):
            absent.add(p.name)
        elif lost or p.at_bound:
            assumed[p.name] = _inside(estimate, p.name, typical[p.name])
    return assumed, absent


def interval_error(p: ParameterEstimate) -> float:
    """One standard error, as wide as the interval; 0 without one."""
    return 0.0 if p.interval is None else 0.5 * (p.interval[1] - p.interval[0]) / NORMAL


def _is_lost(p: ParameterEstimate) -> bool:
    return p.at_bound is not None or interval_error(p) > _INSIGNIFICANT * abs(p.value)


def _inside(estimate: Estimate, name: str, value: float) -> float:
    """A value inside the bounds that the joint states."""
    known = estimate.joint.parameters.get(name)
    if known is not None:
        value = max(value, -math.inf if known.min is None else known.min)
        value = min(value, math.inf if known.max is None else known.max)
    return value
