"""What the tolerances of a joint's facts mean for each parameter.

A fact acts in two ways: it scales the drive's torque, or it moves a parameter that the identification holds fixed
(the inertia, gravity). A torque that is larger by a share gives coefficients that are all larger by it, where the
fixed ones are smaller by it beforehand: so both are a refit over the same windows with other fixed values.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.base.values import dataclass
from jointid.identification.search.domain import SearchDomain
from jointid.identification.search.stated_bounds import known_values
from jointid.joint.joint import Joint
from jointid.joint.tolerances import Tolerances, share_of
from jointid.problem.constant_torque import with_fixed_offset
from jointid.problem.problem import Problem
from jointid.problem.windows import Windows

Array = NDArray[np.float64]

_SAME = 1e-9  # share by which a fixed value may differ from what the joint's facts give


@dataclass(frozen=True, slots=True, kw_only=True)
class _Change:
    """What a fact at the limit of its tolerance changes: the scale of the torque, and fixed parameters."""

    scale: float
    moved: Array


def of_given_facts(
    problem: Problem, windows: Windows, domain: SearchDomain, best: Array
) -> Array | None:
    """Return how far each parameter moves when the given facts are at the limits of their tolerances.

    Parameters
    ----------
    problem : Problem
    windows : int, float, str, WindowOptions or None
        As given in the call.
    domain : SearchDomain
    best : ndarray, shape (p,)
        The parameters found.

    Returns
    -------
    ndarray, shape (p,), or None
        The root of the sum of the facts' squares, of each fact the limit that moves the parameter more; None
        without tolerances.
    """
    joint = problem.joint
    if joint is None or not joint.tolerances.given:
        return None
    parts = problem.parts(windows)
    # Shapes do not grow with the torque, nor does friction as a share of the load.
    scaled = {term.name for term in map(_core.term, problem.choice.terms) if not term.needs_load}
    linear = np.array([name.split("[")[0] in scaled for name in domain.names])

    low, high = with_fixed_offset(domain.names, domain.lower, domain.upper, best)

    def refitted(change: _Change, side: float) -> Array:
        """The parameters with the fact at one of its limits."""
        scale = np.where(linear, 1.0 + side * change.scale, 1.0)
        lower = (low + side * change.moved) / scale
        upper = (high + side * change.moved) / scale
        start = np.clip(best / scale, lower, upper)
        return np.asarray(scale * parts.refit(lower, upper, start, threads=problem.threads))

    same = parts.refit(low, high, best, threads=problem.threads)
    square = np.zeros(len(best))
    for change in _changes(problem, joint, domain, best):
        if change.scale or np.any(change.moved):
            moved = [np.abs(refitted(change, side) - same) for side in (-1.0, 1.0)]
            square += np.maximum(*moved) ** 2
    return np.sqrt(square)


def _changes(
    problem: Problem, joint: Joint, domain: SearchDomain, best: Array
) -> Iterator[_Change]:
    facts, known = joint.facts, known_values(joint)
    for name, stated in joint.tolerances.given.items():
        if name not in facts:  # how alike the directions are: see undivided.py
            continue
        size = joint.tolerances.size(name, facts[name])
        scale = 0.0
        if name == "torque_constant":
            scale = share_of(stated) if isinstance(stated, str) else _ratio(size, facts[name])
        elif name == "gear_ratio" and any(run.torque is None for run in problem.recordings):
            scale = _ratio(size, facts[name])
        moved = np.zeros(len(best))
        if size is not None:
            other = known_values(_changed(joint, name, size))
            for i, parameter in enumerate(domain.names):
                base = parameter.split("[")[0]
                if base not in known or not domain.fixed(parameter):
                    continue
                value = known[base].value or 0.0
                if abs(best[i] - value) <= _SAME * abs(value):  # not a value that the call fixed
                    moved[i] = (other[base].value or 0.0) - value
        yield _Change(scale=scale, moved=moved)


def _ratio(size: float | None, fact: float | None) -> float:
    return 0.0 if size is None or not fact else size / abs(fact)


def _changed(joint: Joint, name: str, size: float) -> Joint:
    """The joint with one fact at the upper limit of its tolerance."""
    joint = joint.replace(tolerances=Tolerances())
    if name in ("mass", "centre_of_mass", "link_inertia"):
        assert joint.link is not None
        field = name.removeprefix("link_")
        larger = getattr(joint.link, field) + size
        return joint.replace(link=replace(joint.link, **{field: larger}))
    if joint.inertia is not None:  # it goes before that of the rotor
        joint = joint.replace(rotor_inertia=None)
        if name == "rotor_inertia":
            return joint
    return joint.replace(**{name: getattr(joint, name) + size})
