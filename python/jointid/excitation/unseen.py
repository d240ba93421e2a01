"""Low-speed friction that the recordings do not show, and its values in the design of a next motion."""

from __future__ import annotations

import math

import numpy as np

from jointid import _core
from jointid.estimate.estimate import Estimate
from jointid.estimate.intervals import NORMAL
from jointid.estimate.statistics import ParameterEstimate

_EXCESS = 0.2  # share of Coulomb friction: the largest assumed static excess
_NEGLIGIBLE = 0.02  # share of Coulomb friction: a smaller excess is absent
_FADED = 1.0 / 30.0  # share of the top speed at which it fades
_INSIGNIFICANT = 0.5  # share of its value: limit of the standard error


def unseen_friction(estimate: Estimate) -> tuple[dict[str, float], set[str]]:
    """Return assumed values of low-speed friction, and the parameters of friction that is certainly absent.

    If a bound limits the static excess or the excess is not significant, its estimate is not used. The
    assumed excess is as large as the interval allows, at most a fifth of the Coulomb friction. It fades at a
    thirtieth of the top speed. An excess is absent if the interval keeps it below 2 % of the Coulomb
    friction.
    """
    found = estimate.parameters
    terms = [_core.term(key) for key in estimate.settings["terms"]]
    fading = [term for term in terms if _is_fading(term) and found[term.name].vary]
    dry = {term.side: term.name for term in terms if term.settles}
    shapes = {name: found[name] for term in fading for name in term.shapes if found[name].vary}
    assumed: dict[str, float] = {}
    absent: set[str] = set()
    for term in fading:
        p = found[term.name]
        level = abs(found[dry[term.side]].value) if term.side in dry else 0.0
        if not _is_lost(p):
            continue
        largest = math.inf if p.at_bound else p.value + NORMAL * interval_error(p)
        if largest < _NEGLIGIBLE * level or level == 0.0:
            absent.add(p.name)
        else:
            assumed[p.name] = _inside(estimate, p.name, min(largest, _EXCESS * level))
    lost = fading and len(absent) + len(assumed) == len(fading)
    speed = float(np.max(np.abs(estimate.windows.velocity), initial=0.0))
    slow = _FADED * speed if speed > 0.0 else 1.0
    for name, p in shapes.items():
        shape = _core.shape(name)
        if len(absent) == len(fading):
            absent.add(name)
        elif lost or p.at_bound:
            typical = slow**shape.speed_power if shape.speed_power else shape.typical
            assumed[name] = _inside(estimate, name, typical)
    return assumed, absent


def _is_fading(term: _core.Term) -> bool:
    return bool(term.friction and term.shapes) and not term.settles


def interval_error(p: ParameterEstimate) -> float:
    """Return one standard error that corresponds to the interval's width; 0 without an interval."""
    return 0.0 if p.interval is None else 0.5 * (p.interval[1] - p.interval[0]) / NORMAL


def _is_lost(p: ParameterEstimate) -> bool:
    return p.at_bound is not None or interval_error(p) > _INSIGNIFICANT * abs(p.value)


def _inside(estimate: Estimate, name: str, value: float) -> float:
    """Return the value, limited to the bounds in the joint."""
    known = estimate.joint.parameters.get(name)
    if known is not None:
        value = max(value, -math.inf if known.min is None else known.min)
        value = min(value, math.inf if known.max is None else known.max)
    return value
