"""Effect of the tolerances of a joint's facts on each parameter.

A fact acts in two ways: it scales the drive's torque, or it changes a fixed parameter (inertia, gravity). Scaling the
torque by a factor is equivalent to dividing the fixed parameters by it and scaling all results. Both effects are
therefore computed by a refit over the same windows with other fixed values.
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

_SAME = 1e-9  # largest relative difference between a fixed value and that from the facts


@dataclass(frozen=True, slots=True, kw_only=True)
class _Change:
    """Change of the torque's scale and of fixed parameters by a fact at the limit of its tolerance."""

    scale: float
    moved: Array


def of_given_facts(
    problem: Problem, windows: Windows, domain: SearchDomain, best: Array
) -> Array | None:
    """Return the change of each parameter when the facts are at the limits of their tolerances.

    Parameters
    ----------
    problem : Problem
    windows : int, float, str, WindowOptions or None
        Windows of the call.
    domain : SearchDomain
    best : ndarray, shape (p,)
        Estimated parameters.

    Returns
    -------
    ndarray, shape (p,), or None
        Root of the sum of squares over the facts. For each fact, the limit with the larger change counts. None
        without tolerances.
    """
    joint = problem.joint
    if joint is None or not joint.tolerances.given:
        return None
    parts = problem.parts(windows)
    # Shapes and load-dependent friction coefficients do not scale with the torque.
    scaled = {term.name for term in map(_core.term, problem.choice.terms) if not term.needs_load}
    linear = np.array([name.split("[")[0] in scaled for name in domain.names])

    low, high = with_fixed_offset(domain.names, domain.lower, domain.upper, best)

    def refitted(change: _Change, side: float) -> Array:
        """Return the parameters with the fact at one of its limits."""
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
        if name not in facts:  # the symmetry of friction: see offset_or_asymmetry.py
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
                if abs(best[i] - value) <= _SAME * abs(value):  # otherwise the call fixed the value
                    moved[i] = (other[base].value or 0.0) - value
        yield _Change(scale=scale, moved=moved)


def _ratio(size: float | None, fact: float | None) -> float:
    return 0.0 if size is None or not fact else size / abs(fact)


def _changed(joint: Joint, name: str, size: float) -> Joint:
    """Return the joint with one fact at the upper limit of its tolerance."""
    joint = joint.replace(tolerances=Tolerances())
    if name in ("mass", "centre_of_mass", "link_inertia"):
        assert joint.link is not None
        field = name.removeprefix("link_")
        larger = getattr(joint.link, field) + size
        return joint.replace(link=replace(joint.link, **{field: larger}))
    if joint.inertia is not None:  # it has priority over the rotor inertia
        joint = joint.replace(rotor_inertia=None)
        if name == "rotor_inertia":
            return joint
    return joint.replace(**{name: getattr(joint, name) + size})
