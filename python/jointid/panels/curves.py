"""Curve of a joint's friction over velocity, from the values of its parameters."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from jointid import _core
from jointid.estimate.friction_map import friction_torque
from jointid.panels.marks import Line

if TYPE_CHECKING:
    from jointid.joint.joint import Joint

_SPEEDS = 300  # points of a curve in each direction


def known_values(joint: Joint) -> dict[str, float]:
    """Return the parameters of a joint that have values."""
    return {name: p.value for name, p in joint.parameters.items() if p.value is not None}


def friction_terms(values: Mapping[str, float]) -> list[str]:
    """Return the friction terms with values for their coefficient and shapes."""
    return [
        term.key
        for term in _core.terms()
        if term.friction and not term.family and {term.name, *term.shapes} <= set(values)
    ]


def friction_line(
    values: Mapping[str, float],
    peak: float,
    *,
    above: float = 0.0,
    forward: bool = False,
    **appearance: Any,
) -> Line:
    """Return the curve of friction. It is interrupted at rest, where friction can have any value in between.

    Parameters
    ----------
    values : mapping of str to float
    peak : float
        Largest speed.
    above : float
        Added to the friction. Default 0.
    forward : bool
        Whether only positive velocities are drawn. Default False.
    **appearance
        Look, label, and dashes of the line.
    """
    speed = peak * np.linspace(0.0, 1.0, _SPEEDS) ** 2  # dense near rest, where it is nonlinear
    speed[0] = 1e-9 * peak
    velocity = np.concatenate([-speed[::-1], speed])
    torque = friction_torque(friction_terms(values), values, velocity) + above
    velocity, torque = np.insert(velocity, _SPEEDS, 0.0), np.insert(torque, _SPEEDS, np.nan)
    shown = slice(_SPEEDS + 1, None) if forward else slice(None)
    return Line(across=velocity[shown], up=torque[shown], **appearance)
